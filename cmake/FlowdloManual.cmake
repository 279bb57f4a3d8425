# The command's manual pages and its completion for bash, zsh and fish, made by the command itself,
# which asks flowdlo-lab for what synth and eval take, where that is built. A cross build has nobody to run it and
# does without.
if(CMAKE_CROSSCOMPILING AND NOT CMAKE_CROSSCOMPILING_EMULATOR)
  message(STATUS "Manual pages and completion are left out: the command cannot run here")
  return()
endif()
if(FLOWDLO_SANITIZE OR FLOWDLO_FUZZ)  # nobody installs such a build
  return()
endif()
find_program(FLOWDLO_GZIP gzip)
mark_as_advanced(FLOWDLO_GZIP)

set(manual "${PROJECT_BINARY_DIR}/share/man/man1")
set(completion "${PROJECT_BINARY_DIR}/share/completion")
set(compress "${CMAKE_COMMAND}" -E true)
if(FLOWDLO_GZIP)
  set(compress "${FLOWDLO_GZIP}" -9nfr "${manual}")
endif()
add_custom_command(
  OUTPUT "${completion}/flowdlo.fish"
  COMMAND "${CMAKE_COMMAND}" -E rm -rf "${manual}" "${completion}"
  COMMAND "${CMAKE_COMMAND}" -E make_directory "${manual}" "${completion}"
  COMMAND flowdlo_cli manual "${manual}"
  COMMAND ${compress}
  COMMAND flowdlo_cli completion bash > "${completion}/flowdlo"
  COMMAND flowdlo_cli completion zsh > "${completion}/_flowdlo"
  COMMAND flowdlo_cli completion fish > "${completion}/flowdlo.fish"
  DEPENDS flowdlo_cli $<TARGET_NAME_IF_EXISTS:flowdlo_lab_cli> VERBATIM)
add_custom_target(flowdlo_manual ALL DEPENDS "${completion}/flowdlo.fish")

install(DIRECTORY "${manual}/" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT command OPTIONAL)
install(FILES "${completion}/flowdlo" COMPONENT command OPTIONAL
        DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions")
install(FILES "${completion}/_flowdlo" COMPONENT command OPTIONAL
        DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions")
install(FILES "${completion}/flowdlo.fish" COMPONENT command OPTIONAL
        DESTINATION "${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d")
