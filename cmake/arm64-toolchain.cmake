# A Raspberry Pi 3 with Debian 12: Debian's cross compiler, the root that arm64-sysroot.sh made, qemu-user for the tests.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)

set(VLP_ARM64_SYSROOT "${CMAKE_CURRENT_LIST_DIR}/../build/arm64-sysroot" CACHE PATH "What cmake/arm64-sysroot.sh made")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES VLP_ARM64_SYSROOT)
get_filename_component(CMAKE_SYSROOT "${VLP_ARM64_SYSROOT}" ABSOLUTE)
if(NOT EXISTS "${CMAKE_SYSROOT}/usr/lib/aarch64-linux-gnu")
  message(FATAL_ERROR "VLP_ARM64_SYSROOT: no arm64 root in ${CMAKE_SYSROOT}; first: bash cmake/arm64-sysroot.sh")
endif()
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)

# In the order that suits a Cortex-A53; runs on every 64-bit ARM.
set(CMAKE_CXX_FLAGS_INIT "-march=armv8-a -mtune=cortex-a53")

# Only what a Cortex-A53 can do; anything else ends the program with SIGILL.
set(CMAKE_CROSSCOMPILING_EMULATOR "qemu-aarch64;-cpu;cortex-a53;-L;${CMAKE_SYSROOT}")
