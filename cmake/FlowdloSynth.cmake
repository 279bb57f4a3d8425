# FLOWDLO_BUILD_SYNTH: synthetic scenes need Embree, 4 or 3. AUTO builds them where it is installed.
# Leaves flowdlo_synth behind, or FLOWDLO_SYNTH_LACKS, a sentence that says what is missing.
set(FLOWDLO_BUILD_SYNTH AUTO CACHE STRING "Build flowdlo synth: AUTO (where Embree is), ON or OFF")
set_property(CACHE FLOWDLO_BUILD_SYNTH PROPERTY STRINGS AUTO ON OFF)

set(FLOWDLO_SYNTH_LACKS "it was built with FLOWDLO_BUILD_SYNTH=OFF")
if(FLOWDLO_BUILD_SYNTH)
  foreach(version 4 3)
    find_path(FLOWDLO_EMBREE${version}_INCLUDE_DIR embree${version}/rtcore.h)
    find_library(FLOWDLO_EMBREE${version}_LIBRARY embree${version})
    mark_as_advanced(FLOWDLO_EMBREE${version}_INCLUDE_DIR FLOWDLO_EMBREE${version}_LIBRARY)
    if(FLOWDLO_EMBREE${version}_INCLUDE_DIR AND FLOWDLO_EMBREE${version}_LIBRARY)
      add_library(flowdlo_embree INTERFACE)
      target_include_directories(flowdlo_embree SYSTEM INTERFACE
                                 "${FLOWDLO_EMBREE${version}_INCLUDE_DIR}")
      target_link_libraries(flowdlo_embree INTERFACE "${FLOWDLO_EMBREE${version}_LIBRARY}")
      target_compile_definitions(flowdlo_embree INTERFACE FLOWDLO_EMBREE_${version})
      break()
    endif()
  endforeach()
  set(FLOWDLO_SYNTH_LACKS "Embree was not found when it was built (Debian: libembree-dev)")
  if(TARGET flowdlo_embree)
    add_subdirectory("${PROJECT_SOURCE_DIR}/lab/synth")
  elseif(NOT FLOWDLO_BUILD_SYNTH STREQUAL "AUTO")
    message(FATAL_ERROR "FLOWDLO_BUILD_SYNTH: expected Embree 4 or 3, found none; "
                        "install libembree-dev, or set it to AUTO or OFF")
  endif()
endif()
