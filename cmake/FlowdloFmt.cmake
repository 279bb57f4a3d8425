# fmt for the library, without its shared library, which another part of a process may bring in
# another version: compiled once here where its headers allow it, else by whoever includes them,
# which takes each of them 3 s more.
find_package(fmt REQUIRED)
add_library(flowdlo_fmt OBJECT "${PROJECT_SOURCE_DIR}/cmake/fmt_functions.cpp")
target_compile_features(flowdlo_fmt PUBLIC cxx_std_20)
target_include_directories(flowdlo_fmt SYSTEM PUBLIC
                           $<TARGET_PROPERTY:fmt::fmt-header-only,INTERFACE_INCLUDE_DIRECTORIES>)
if(fmt_VERSION VERSION_LESS 9 OR fmt_VERSION VERSION_GREATER_EQUAL 10)
  target_compile_definitions(flowdlo_fmt PUBLIC FMT_HEADER_ONLY=1)
else()
  # The command and the tests use fmt's own library beside rooms of this one: names that both may have.
  # flowdlo.map keeps them within libflowdlo.so.
  target_compile_definitions(flowdlo_fmt PUBLIC FMT_SHARED)
  set(FLOWDLO_FMT_HEADER <fmt/format.h>)  # the same for all: it can be precompiled outside the rooms
endif()
set_target_properties(flowdlo_fmt PROPERTIES POSITION_INDEPENDENT_CODE ON
                                             CXX_VISIBILITY_PRESET hidden
                                             VISIBILITY_INLINES_HIDDEN ON)
set_property(GLOBAL APPEND PROPERTY FLOWDLO_ROOMS flowdlo_fmt)
