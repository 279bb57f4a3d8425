# A room is a folder of engine/ and one object library: flowdlo_room(path SOURCES ... DEPENDS ...).
# OWN_FLAGS: its compiler's flags are such that it reads its headers itself.
# Includes are written from engine/: #include "path/path.hpp".

set(CMAKE_UNITY_BUILD OFF)  # FlowdloUnity.cmake knows which files go together

set(FLOWDLO_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                     -Wnon-virtual-dtor -Wold-style-cast)
if(FLOWDLO_WERROR)
  list(APPEND FLOWDLO_WARNINGS -Werror)
endif()

add_library(flowdlo_options INTERFACE)
target_compile_features(flowdlo_options INTERFACE cxx_std_20)
if(PROJECT_IS_TOP_LEVEL)
  target_compile_options(flowdlo_options INTERFACE ${FLOWDLO_WARNINGS})
else()
  # What an embedding project sets for all its code must neither stop ours nor change its answers:
  # warnings that are errors to it, arithmetic without NaN.
  target_compile_options(flowdlo_options INTERFACE
                         "$<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-w;-fno-fast-math>")
endif()
if(FLOWDLO_UNITY AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # A compiler of several files at a time frees its memory once a GiB, not once some MiB: a tenth of its
  # time. And a helper may be named as one of a file before it: whoever compiles files alone is warned.
  target_compile_options(flowdlo_options INTERFACE --param=ggc-min-heapsize=1048576 -Wno-shadow
                                                   -Wno-subobject-linkage)
endif()
if(FLOWDLO_SANITIZE)
  target_compile_options(flowdlo_options INTERFACE -fsanitize=${FLOWDLO_SANITIZE}
                                                   -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(flowdlo_options INTERFACE -fsanitize=${FLOWDLO_SANITIZE})
endif()
# FLOWDLO_FUZZ: what an input reaches is counted; tests/fuzz links the fuzzer itself. Two properties of
# a target decide what else is watched there:
#   FLOWDLO_PARSES      it compares bytes with words of a format: the fuzzer sees both sides, and learns
#                       the words. Geometry watched like that takes twice as long.
#   FLOWDLO_ARITHMETIC  no input changes its course: nothing is watched.
if(FLOWDLO_FUZZ)
  target_compile_options(flowdlo_options INTERFACE
    -fsanitize=fuzzer-no-link
    $<$<NOT:$<BOOL:$<TARGET_PROPERTY:FLOWDLO_PARSES>>>:-fno-sanitize-coverage=trace-cmp>
    $<$<BOOL:$<TARGET_PROPERTY:FLOWDLO_ARITHMETIC>>:-fno-sanitize=all>)
endif()

# Code that takes milliseconds whatever the compiler makes of it: tests, commands, options and tables.
# Half of its compilation was its optimisation.
add_library(flowdlo_glue_options INTERFACE)
target_compile_options(flowdlo_glue_options INTERFACE
  $<$<CONFIG:Release>:$<IF:$<BOOL:${FLOWDLO_UNITY}>,-O0,-O1>>
  $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)  # the latter for ccache

# flowdlo_precompiled(TARGET HEADER ...): a target of no code whose headers are read once for all that
# are built with the same flags.
function(flowdlo_precompiled target)
  add_library(${target} OBJECT "${PROJECT_SOURCE_DIR}/cmake/no_code.cpp")
  target_link_libraries(${target} PRIVATE flowdlo_options)
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)  # for ccache
  target_precompile_headers(${target} PRIVATE ${ARGN})
endfunction()

# flowdlo_reuse_headers(TARGET FROM): TARGET takes the headers that FROM has read.
function(flowdlo_reuse_headers target from)
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
  target_precompile_headers(${target} REUSE_FROM ${from})
endfunction()

define_property(GLOBAL PROPERTY FLOWDLO_ROOMS BRIEF_DOCS "Object libraries that make up flowdlo")

function(flowdlo_room name)
  cmake_parse_arguments(ROOM "OWN_FLAGS" "" "SOURCES;DEPENDS" ${ARGN})
  set(target flowdlo_${name})
  add_library(${target} OBJECT ${ROOM_SOURCES})
  target_include_directories(${target} PUBLIC "${PROJECT_SOURCE_DIR}/include"
                                              "${PROJECT_BINARY_DIR}/include"
                                              "${PROJECT_SOURCE_DIR}/engine")
  target_link_libraries(${target} PUBLIC flowdlo_options flowdlo_fmt Eigen3::Eigen ${ROOM_DEPENDS})
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON
                                             CXX_VISIBILITY_PRESET hidden
                                             VISIBILITY_INLINES_HIDDEN ON)
  if(NOT ROOM_OWN_FLAGS AND NOT FLOWDLO_FUZZ)  # there each room has what is watched in it
    flowdlo_reuse_headers(${target} flowdlo_room_headers)
  endif()
  set_property(GLOBAL APPEND PROPERTY FLOWDLO_ROOMS ${target})
endfunction()
