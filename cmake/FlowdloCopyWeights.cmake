# flowdlo_copy_weights(target): the shipped weights, 12 MB, go to share/flowdlo/ in the folder of this
# executable or library whenever it is built. There a library finds them that does not carry them
# itself. `target` is one of the folder that calls. Read by the project's own build and, installed, by
# find_package(flowdlo).
function(flowdlo_copy_weights target)
  get_property(folder GLOBAL PROPERTY FLOWDLO_WEIGHTS_FOLDER)
  set(files)
  foreach(name flowdlo.fdw field.safetensors)
    list(APPEND files "${folder}/${name}")
  endforeach()
  set(beside "$<TARGET_FILE_DIR:${target}>/share/flowdlo")
  add_custom_command(
    TARGET ${target} POST_BUILD
    COMMAND "${CMAKE_COMMAND}" -E make_directory "${beside}"
    COMMAND "${CMAKE_COMMAND}" -E copy_if_different ${files} "${beside}"
    VERBATIM)
  if(TARGET flowdlo_default_weights)  # in flowdlo's own build they have to be laid out first
    add_dependencies(${target} flowdlo_default_weights)
  endif()
endfunction()
