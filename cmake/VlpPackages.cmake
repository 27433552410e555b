# Debian packages: `cmake --build --preset release --target packages` writes them to build/release/packages.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME visp-vlp)
set(CPACK_PACKAGE_CONTACT "visp_vlp developers <visp-vlp@localhost>")
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}/packages")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL libraries dev tools doc)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${CMAKE_LIBRARY_OUTPUT_DIRECTORY}")

set(library libvisp-vlp${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(CPACK_DEBIAN_LIBRARIES_PACKAGE_NAME ${library})
set(CPACK_DEBIAN_LIBRARIES_PACKAGE_SECTION libs)
set(CPACK_COMPONENT_LIBRARIES_DESCRIPTION "Visible light positioning for ViSP: libraries
 A rolling-shutter camera looks up at ceiling lamps that blink: the stripes say which lamp it is, two lamps or more say
 where the robot is.")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libvisp-vlp-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
    "${library} (= ${PROJECT_VERSION}), libvisp-dev, libopencv-dev, libeigen3-dev, libyaml-cpp-dev")
set(CPACK_COMPONENT_DEV_DESCRIPTION "Visible light positioning for ViSP: headers and CMake package")
set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME visp-vlp-tools)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_TOOLS_PACKAGE_DEPENDS "${library} (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_TOOLS_PACKAGE_RECOMMENDS gnuplot-nox)
set(CPACK_COMPONENT_TOOLS_DESCRIPTION
    "Visible light positioning for ViSP: programs
 Poses from pictures, line following, calibration, simulation, evaluation and planning of lamps; with sample data.")
set(CPACK_DEBIAN_DOC_PACKAGE_NAME visp-vlp-doc)
set(CPACK_DEBIAN_DOC_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
set(CPACK_COMPONENT_DOC_DESCRIPTION "Visible light positioning for ViSP: tutorials, benchmarks and reference")
include(CPack)

add_custom_target(packages COMMAND "${CMAKE_CPACK_COMMAND}" --config "${PROJECT_BINARY_DIR}/CPackConfig.cmake" USES_TERMINAL)
if(TARGET man)
  add_dependencies(packages man)
endif()
if(VLP_BUILD_PROGRAMS)
  add_dependencies(packages vlp-locate vlp-simulate vlp-evaluate vlp-servo vlp-calibrate vlp-plan vlp-lamp)
endif()
