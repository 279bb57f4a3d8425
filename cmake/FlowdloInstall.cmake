# cmake --install: library, public headers, find_package(flowdlo), flowdlo.pc. The command, the
# weights and the example frame install themselves, beside their own targets.
include(CMakePackageConfigHelpers)

set(FLOWDLO_INSTALL_CMAKEDIR "${CMAKE_INSTALL_LIBDIR}/cmake/flowdlo")
set(FLOWDLO_INSTALL_PCDIR "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
set(FLOWDLO_INSTALL_DATADIR "${CMAKE_INSTALL_DATADIR}/flowdlo")

get_target_property(FLOWDLO_LIBRARY_TYPE flowdlo TYPE)

set_target_properties(flowdlo PROPERTIES INSTALL_RPATH "")  # it has no library of ours to find
install(TARGETS flowdlo EXPORT flowdloTargets
        LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT library
                NAMELINK_COMPONENT development
        ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development)
if(TARGET flowdlo_probe)  # libexec/ by that name: the library looks for it from its own place
  install(TARGETS flowdlo_probe RUNTIME DESTINATION libexec/flowdlo COMPONENT library)
endif()
if(FLOWDLO_EMBEDS_WEIGHTS AND FLOWDLO_LIBRARY_TYPE STREQUAL "STATIC_LIBRARY")
  install(TARGETS flowdlo_embedded_weights EXPORT flowdloTargets
          ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development)
endif()
set(left_out)
if(NOT FLOWDLO_WITH_VULKAN)  # what it declares is not there
  set(left_out PATTERN "vulkan.hpp" EXCLUDE)
endif()
install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/flowdlo"
        DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT development FILES_MATCHING PATTERN "*.hpp" PATTERN "*.h" ${left_out})
install(FILES "${PROJECT_BINARY_DIR}/include/flowdlo/version.hpp"
        DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/flowdlo" COMPONENT development)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${FLOWDLO_INSTALL_DATADIR}"
        COMPONENT licence)

install(EXPORT flowdloTargets NAMESPACE flowdlo:: DESTINATION "${FLOWDLO_INSTALL_CMAKEDIR}"
        COMPONENT development)
configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/flowdloConfig.cmake.in"
                              "${PROJECT_BINARY_DIR}/flowdloConfig.cmake"
                              INSTALL_DESTINATION "${FLOWDLO_INSTALL_CMAKEDIR}"
                              PATH_VARS FLOWDLO_INSTALL_DATADIR)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/flowdloConfigVersion.cmake"
                                 COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_SOURCE_DIR}/cmake/FlowdloCopyWeights.cmake"
              "${PROJECT_BINARY_DIR}/flowdloConfig.cmake"
              "${PROJECT_BINARY_DIR}/flowdloConfigVersion.cmake"
        DESTINATION "${FLOWDLO_INSTALL_CMAKEDIR}" COMPONENT development)

# flowdlo.pc finds its prefix from its own place, so that an installed tree can be moved.
file(RELATIVE_PATH FLOWDLO_PC_PREFIX "/${FLOWDLO_INSTALL_PCDIR}" "/")
string(REGEX REPLACE "/$" "" FLOWDLO_PC_PREFIX "${FLOWDLO_PC_PREFIX}")
set(FLOWDLO_PC_REQUIRES "")
set(FLOWDLO_PC_LIBS "")
if(FLOWDLO_LIBRARY_TYPE STREQUAL "STATIC_LIBRARY")
  set(FLOWDLO_PC_REQUIRES "libpng")
  set(FLOWDLO_PC_LIBS " -lpthread -ldl -lstdc++")
  if(FLOWDLO_EMBEDS_WEIGHTS)
    set(FLOWDLO_PC_LIBS " -lflowdlo_weights${FLOWDLO_PC_LIBS}")
  endif()
endif()
configure_file("${PROJECT_SOURCE_DIR}/cmake/flowdlo.pc.in" "${PROJECT_BINARY_DIR}/flowdlo.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/flowdlo.pc" DESTINATION "${FLOWDLO_INSTALL_PCDIR}"
        COMPONENT development)

include(FlowdloPackages)
