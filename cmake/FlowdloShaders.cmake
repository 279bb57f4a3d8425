# flowdlo_shaders(out_sources name...): compiles shaders/<name>.comp to SPIR-V, validates it, and
# embeds it in a C++ file that defines flowdlo::vulkan::shaders::<name>(). Appends those files to
# the variable. No compiler is needed at run time.
find_program(FLOWDLO_GLSLANG glslangValidator REQUIRED
             DOC "GLSL compiler; Debian and Ubuntu: glslang-tools")
find_program(FLOWDLO_SPIRV_VAL spirv-val DOC "SPIR-V validator; Debian and Ubuntu: spirv-tools")
mark_as_advanced(FLOWDLO_GLSLANG FLOWDLO_SPIRV_VAL)

function(flowdlo_shaders out_sources)
  set(source_folder "${PROJECT_SOURCE_DIR}/shaders")
  set(folder "${PROJECT_BINARY_DIR}/shaders")
  file(MAKE_DIRECTORY "${folder}")
  file(GLOB included CONFIGURE_DEPENDS "${source_folder}/*.h" "${source_folder}/*.glsl")
  set(sources)
  foreach(name IN LISTS ARGN)
    set(shader "${source_folder}/${name}.comp")
    set(compile "${FLOWDLO_GLSLANG}" --quiet -V --target-env vulkan1.1  "-I${source_folder}")
    set(validate)
    if(FLOWDLO_SPIRV_VAL)
      set(validate COMMAND "${FLOWDLO_SPIRV_VAL}" --target-env vulkan1.1 "${folder}/${name}.spv")
    endif()
    add_custom_command(
      OUTPUT "${folder}/${name}.spv.h"
      COMMAND ${compile} -o "${folder}/${name}.spv" "${shader}"
      ${validate}
      COMMAND ${compile} --vn ${name}_words -o "${folder}/${name}.spv.h" "${shader}"
      DEPENDS "${shader}" ${included}
      COMMENT "Shader ${name}"
      VERBATIM)
    set(FLOWDLO_SHADER ${name})
    configure_file("${PROJECT_SOURCE_DIR}/cmake/shader.cpp.in" "${folder}/${name}_shader.cpp" @ONLY)
    set_property(SOURCE "${folder}/${name}_shader.cpp" APPEND PROPERTY OBJECT_DEPENDS
                                                                "${folder}/${name}.spv.h")
    list(APPEND sources "${folder}/${name}_shader.cpp" "${folder}/${name}.spv.h")
  endforeach()
  set(${out_sources} ${sources} PARENT_SCOPE)
endfunction()
