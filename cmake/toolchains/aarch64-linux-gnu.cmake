# ARM64 from another machine, by Debian's cross compiler (g++-aarch64-linux-gnu). FLOWDLO_ARM64_SYSROOT,
# as -D or in the environment, is a folder with the target's libraries and headers:
# scripts/arm64-sysroot makes one, and a copy of a board's /usr and /lib is one. Where qemu-aarch64
# (qemu-user) is installed, tests run by it.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc CACHE STRING "C compiler")
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++ CACHE STRING "C++ compiler")

list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES FLOWDLO_ARM64_SYSROOT)
if(NOT FLOWDLO_ARM64_SYSROOT)
  set(FLOWDLO_ARM64_SYSROOT "$ENV{FLOWDLO_ARM64_SYSROOT}" CACHE PATH
      "Folder with the libraries and headers of an ARM64 system")
endif()
if(NOT EXISTS "${FLOWDLO_ARM64_SYSROOT}/usr/include")
  message(FATAL_ERROR "FLOWDLO_ARM64_SYSROOT: expected a folder with usr/include, got "
                      "\"${FLOWDLO_ARM64_SYSROOT}\"; scripts/arm64-sysroot FOLDER makes one")
endif()
set(CMAKE_SYSROOT "${FLOWDLO_ARM64_SYSROOT}")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)  # flatc and glslangValidator run on this machine
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)

find_program(FLOWDLO_QEMU_AARCH64 qemu-aarch64 DOC "Runs programs for ARM64; Debian: qemu-user")
mark_as_advanced(FLOWDLO_QEMU_AARCH64)
if(FLOWDLO_QEMU_AARCH64)
  set(CMAKE_CROSSCOMPILING_EMULATOR "${FLOWDLO_QEMU_AARCH64};-L;${FLOWDLO_ARM64_SYSROOT}")
endif()
