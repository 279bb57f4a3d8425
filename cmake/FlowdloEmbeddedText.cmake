# flowdlo_embed_text(SOURCES NAME FILE HEADER SPACE): FILE of the current folder becomes the C++
# function SPACE::NAME() that HEADER declares; its source file is appended to the list SOURCES.
function(flowdlo_embed_text embedded name file header space)
  set(source "${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp")
  set(script "${PROJECT_SOURCE_DIR}/cmake/embed_text.cmake")
  add_custom_command(
    OUTPUT "${source}"
    COMMAND "${CMAKE_COMMAND}" "-DNAME=${name}" "-DFILE=${CMAKE_CURRENT_SOURCE_DIR}/${file}"
            "-DHEADER=${header}" "-DSPACE=${space}" "-DOUT=${source}" -P "${script}"
    DEPENDS "${file}" "${script}"
    COMMENT "Embedding ${file}"
    VERBATIM)
  set(${embedded} ${${embedded}} "${source}" PARENT_SCOPE)
endfunction()
