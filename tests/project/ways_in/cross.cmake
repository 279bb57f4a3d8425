# A system other than this one, as far as CMake can tell: what is built for it cannot be run.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR elsewhere)
