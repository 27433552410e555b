# What is read: man pages made from --help (target man), the reference (target doc), documents that are installed.
set(documents "${CMAKE_INSTALL_DATADIR}/doc/visp-vlp")
install(FILES README.md BENCHMARK.md CHANGELOG.md LICENSE DESTINATION "${documents}" COMPONENT doc)
install(DIRECTORY tutorial DESTINATION "${documents}" COMPONENT doc)
install(DIRECTORY tests/bench DESTINATION "${documents}/tests" COMPONENT doc FILES_MATCHING PATTERN "*.md")

find_program(HELP2MAN help2man)
if(VLP_BUILD_PROGRAMS AND HELP2MAN)
  set(pages)
  foreach(page "vlp-locate|poses from pictures of blinking lamps" "vlp-simulate|a scenario to frames with ground truth"
               "vlp-evaluate|poses held against the truth" "vlp-servo|drives a robot along a path by blinking lamps"
               "vlp-calibrate|camera, shutter, mount and lamps from pictures" "vlp-plan|how lamps should blink"
               "vlp-lamp|tells lamps how to blink")
    string(REPLACE "|" ";" page "${page}")
    list(GET page 0 program)
    list(GET page 1 purpose)
    set(file "${PROJECT_BINARY_DIR}/man/${program}.1")
    add_custom_command(OUTPUT "${file}" COMMAND "${CMAKE_COMMAND}" -E make_directory "${PROJECT_BINARY_DIR}/man"
                       COMMAND "${HELP2MAN}" --no-info --section 1 --name "${purpose}" --output "${file}" "$<TARGET_FILE:${program}>"
                       DEPENDS ${program} VERBATIM)
    list(APPEND pages "${file}")
  endforeach()
  add_custom_target(man DEPENDS ${pages})
  install(FILES ${pages} DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT tools OPTIONAL)
endif()

find_package(Doxygen QUIET)
if(DOXYGEN_FOUND)
  set(DOXYGEN_PROJECT_NAME visp_vlp)
  set(DOXYGEN_USE_MDFILE_AS_MAINPAGE "${PROJECT_SOURCE_DIR}/README.md")
  set(DOXYGEN_STRIP_FROM_PATH "${PROJECT_SOURCE_DIR}")
  set(DOXYGEN_FULL_PATH_NAMES YES)
  set(DOXYGEN_QT_AUTOBRIEF YES)
  set(DOXYGEN_WARN_IF_UNDOCUMENTED NO)
  set(DOXYGEN_EXTRACT_ALL YES)
  set(DOXYGEN_MACRO_EXPANSION YES)
  set(DOXYGEN_EXPAND_ONLY_PREDEF YES)
  set(DOXYGEN_PREDEFINED VISP_EXPORT=)
  set(DOXYGEN_WARN_IF_INCOMPLETE_DOC NO) # types explain the rest
  set(DOXYGEN_EXAMPLE_PATH tutorial)
  set(DOXYGEN_EXAMPLE_RECURSIVE YES)
  set(DOXYGEN_GENERATE_LATEX NO)
  set(DOXYGEN_USE_MATHJAX YES)
  set(DOXYGEN_HAVE_DOT NO)
  set(DOXYGEN_EXCLUDE_PATTERNS "*.cpp" "*/bench/*.h")
  set(DOXYGEN_QUIET YES)
  set(DOXYGEN_WARN_LOGFILE "${PROJECT_BINARY_DIR}/doc-warnings.txt")
  set(DOXYGEN_FILTER_PATTERNS "*.h=${PROJECT_SOURCE_DIR}/cmake/doxygen-header.sh")
  file(GLOB includes CONFIGURE_DEPENDS modules/*/include)
  doxygen_add_docs(doc modules/modules.dox ${includes} README.md BENCHMARK.md CONTRIBUTING.md SECURITY.md apps/README.md apps/options.md
                   apps/ros/README.md apps/lamp-firmware/README.md
                   data/README.md tutorial tests/bench modules/vlp_localization/src/MODEL.md modules/vlp_servo/HAZARDS.md tests/fuzz/README.md
                   COMMENT "Reference in ${PROJECT_BINARY_DIR}/html")
  install(DIRECTORY "${PROJECT_BINARY_DIR}/html" DESTINATION "${documents}" COMPONENT doc OPTIONAL)
endif()
