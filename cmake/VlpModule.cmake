# The five macros by which a ViSP module describes itself, over an installed ViSP, whose package has none of them. They
# take the same arguments as ViSP's own, which replace them where a module is built inside a ViSP source tree.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release, RelWithDebInfo or MinSizeRel" FORCE)
endif()
option(BUILD_SHARED_LIBS "Shared libraries, as ViSP's own" ON)
option(VLP_BUILD_TESTS "Build the tests" ON)
if(VLP_BUILD_TESTS)
  enable_testing()
endif()
add_custom_target(tested) # what ctest runs: all but the benchmarks that are run by hand
include(GNUInstallDirs)

# VISPConfig.cmake appends -fopenmp -fPIC to the flags of whoever reads it; ours stay as they were.
set(vlp_cxx_flags "${CMAKE_CXX_FLAGS}")
find_package(VISP 3.5 REQUIRED)
set(CMAKE_CXX_FLAGS "${vlp_cxx_flags}")
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
add_compile_options(-Wall -Wextra)
if(CMAKE_UNITY_BUILD)
  add_compile_options(-Wno-subobject-linkage) # a source that another includes is not a header
endif()

# vp_add_module(<name> [REQUIRED] <module>... [OPTIONAL <module>...])
macro(vp_add_module module_name)
  set(name ${module_name})
  set(the_module visp_${name})
  set(vlp_depends)
  set(vlp_kind REQUIRED)
  foreach(depend ${ARGN})
    if(depend MATCHES "^(REQUIRED|OPTIONAL)$")
      set(vlp_kind ${depend})
      continue()
    endif()
    # A module configured alone brings along the siblings that it stands on.
    string(REGEX REPLACE "^visp_" "" sibling ${depend})
    if(NOT TARGET ${depend} AND EXISTS "${CMAKE_CURRENT_LIST_DIR}/../${sibling}")
      add_subdirectory("${CMAKE_CURRENT_LIST_DIR}/../${sibling}" "${CMAKE_BINARY_DIR}/${sibling}")
    endif()
    if(TARGET ${depend})
      list(APPEND vlp_depends ${depend})
    elseif(vlp_kind STREQUAL "REQUIRED")
      message(FATAL_ERROR "${the_module} needs ${depend}, which this ViSP lacks")
    endif()
  endforeach()
endmacro()

# vp_glob_module_sources(): src/**/*.{cpp,h} and include/visp3/<name>/*.h
macro(vp_glob_module_sources)
  file(GLOB_RECURSE vlp_sources CONFIGURE_DEPENDS
       "${CMAKE_CURRENT_LIST_DIR}/src/*.cpp" "${CMAKE_CURRENT_LIST_DIR}/src/*.h")
  file(GLOB vlp_headers CONFIGURE_DEPENDS "${CMAKE_CURRENT_LIST_DIR}/include/visp3/${name}/*.h")
endmacro()

# vp_module_include_directories(<directory of a third party>...)
macro(vp_module_include_directories)
  set(vlp_include_directories ${ARGN})
endmacro()

# vp_create_module(<library>... [LINK_PRIVATE <library>...])
macro(vp_create_module)
  add_library(${the_module} ${vlp_sources} ${vlp_headers})
  add_library(visp_vlp::${name} ALIAS ${the_module})
  target_compile_features(${the_module} PUBLIC cxx_std_17)
  target_include_directories(${the_module}
    PUBLIC "$<BUILD_INTERFACE:${CMAKE_CURRENT_LIST_DIR}/include>" "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>"
    PRIVATE "${CMAKE_CURRENT_LIST_DIR}/src")
  set(vlp_installed_directories ${vlp_include_directories})
  if(CMAKE_SYSROOT) # where the machine that it is built for has them
    string(REPLACE "${CMAKE_SYSROOT}/" "/" vlp_installed_directories "${vlp_include_directories}")
  endif()
  target_include_directories(${the_module} SYSTEM
    PUBLIC "$<BUILD_INTERFACE:${vlp_include_directories}>" "$<INSTALL_INTERFACE:${vlp_installed_directories}>")
  target_link_libraries(${the_module} LINK_PUBLIC ${vlp_depends} ${ARGN})
  # Reading these headers is half of the time that a file takes. All modules share what the lowest one compiled.
  if(the_module STREQUAL "visp_vlp_core")
    target_precompile_headers(${the_module} PRIVATE <algorithm> <cmath> <functional> <memory> <optional> <string> <vector>
                              <Eigen/Dense> <visp3/core/vpCameraParameters.h> <visp3/core/vpException.h>
                              <visp3/core/vpHomogeneousMatrix.h> <visp3/core/vpImage.h>)
  elseif(TARGET visp_vlp_core)
    target_precompile_headers(${the_module} REUSE_FROM visp_vlp_core)
  endif()
  set_target_properties(${the_module} PROPERTIES EXPORT_NAME ${name} DEFINE_SYMBOL visp_vlp_EXPORTS)
  if(visp_vlp_VERSION)
    set_target_properties(${the_module} PROPERTIES VERSION ${visp_vlp_VERSION}
                          SOVERSION ${visp_vlp_VERSION_MAJOR}.${visp_vlp_VERSION_MINOR})
  endif()
  install(TARGETS ${the_module} EXPORT visp_vlpTargets COMPONENT dev LIBRARY COMPONENT libraries NAMELINK_COMPONENT dev)
  install(FILES ${vlp_headers} DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/visp3/${name}" COMPONENT dev)
endmacro()

# vp_add_tests([DEPENDS_ON <module>...]): a program for each test/**/*.cpp of the module's own folder, run as ViSP does.
macro(vp_add_tests)
  if(VLP_BUILD_TESTS)
    file(GLOB_RECURSE vlp_tests CONFIGURE_DEPENDS "${CMAKE_CURRENT_LIST_DIR}/test/*.cpp")
    set(vlp_test_depends ${ARGN})
    list(REMOVE_ITEM vlp_test_depends DEPENDS_ON)
    foreach(test_source ${vlp_tests})
      get_filename_component(test_name "${test_source}" NAME_WE)
      add_executable(${test_name} "${test_source}")
      target_link_libraries(${test_name} PRIVATE ${the_module} ${vlp_test_depends})
      add_dependencies(tested ${test_name})
      add_test(NAME ${test_name} COMMAND ${test_name} -c -d)
    endforeach()
  endif()
endmacro()
