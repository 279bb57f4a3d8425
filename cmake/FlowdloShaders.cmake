# flowdlo_shaders(out_sources name...): compiles shaders/<name>.comp to SPIR-V, validates it, and
# embeds it in a C++ file that defines flowdlo::vulkan::shaders::<name>(). Appends those files to
# the variable. No compiler is needed at run time. With NEEDS EXTENSION, and a compiler that does not
# know that extension of GLSL, the shader has no words, and who wants it must do without. A shader that
# asks for PLAIN is compiled a second time with that defined, for devices without shuffles.
find_program(FLOWDLO_GLSLANG glslangValidator REQUIRED
             DOC "GLSL compiler; Debian and Ubuntu: glslang-tools")
find_program(FLOWDLO_SPIRV_VAL spirv-val DOC "SPIR-V validator; Debian and Ubuntu: spirv-tools")
mark_as_advanced(FLOWDLO_GLSLANG FLOWDLO_SPIRV_VAL)

function(flowdlo_knows_extension extension out_known)
  set(probe "${PROJECT_BINARY_DIR}/shaders/${extension}.comp")
  file(WRITE "${probe}" "#version 450\n#extension ${extension} : require\nvoid main() {}\n")
  execute_process(COMMAND "${FLOWDLO_GLSLANG}" -V --target-env vulkan1.1 -o "${probe}.spv" "${probe}"
                  RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
  if(failed)
    message(STATUS "${FLOWDLO_GLSLANG} does not know ${extension}: built without")
    set(${out_known} OFF PARENT_SCOPE)
  else()
    set(${out_known} ON PARENT_SCOPE)
  endif()
endfunction()

function(flowdlo_shaders out_sources)
  cmake_parse_arguments(SHADERS "" "NEEDS" "" ${ARGN})
  set(known ON)
  if(SHADERS_NEEDS)
    flowdlo_knows_extension(${SHADERS_NEEDS} known)
  endif()
  set(source_folder "${PROJECT_SOURCE_DIR}/shaders")
  set(folder "${PROJECT_BINARY_DIR}/shaders")
  file(MAKE_DIRECTORY "${folder}")
  file(GLOB included CONFIGURE_DEPENDS "${source_folder}/*.h" "${source_folder}/*.glsl")
  set(sources ${${out_sources}})
  foreach(name IN LISTS SHADERS_UNPARSED_ARGUMENTS)
    set(shader "${source_folder}/${name}.comp")
    set(compile "${FLOWDLO_GLSLANG}" --quiet -V --target-env vulkan1.1 "-I${source_folder}")
    set(validate)
    if(FLOWDLO_SPIRV_VAL)
      set(validate COMMAND "${FLOWDLO_SPIRV_VAL}" --target-env vulkan1.1 "${folder}/${name}.spv")
    endif()
    if(NOT known)
      set(FLOWDLO_SHADER ${name})
      configure_file("${PROJECT_SOURCE_DIR}/cmake/no_shader.cpp.in"
                     "${folder}/${name}_shader.cpp" @ONLY)
      list(APPEND sources "${folder}/${name}_shader.cpp")
      continue()
    endif()
    set(plain)
    set(plain_words)
    set(FLOWDLO_PLAIN_INCLUDE "")
    set(FLOWDLO_PLAIN_WORDS "{}")
    file(STRINGS "${shader}" asks REGEX "^#if.*PLAIN")
    if(asks)
      set(plain COMMAND ${compile} -DPLAIN -o "${folder}/${name}_plain.spv" "${shader}")
      if(FLOWDLO_SPIRV_VAL)
        list(APPEND plain COMMAND "${FLOWDLO_SPIRV_VAL}" --target-env vulkan1.1
                                  "${folder}/${name}_plain.spv")
      endif()
      list(APPEND plain COMMAND ${compile} -DPLAIN --vn ${name}_plain_words
                                -o "${folder}/${name}_plain.spv.h" "${shader}")
      set(plain_words "${folder}/${name}_plain.spv.h")
      set(FLOWDLO_PLAIN_INCLUDE "#include \"${name}_plain.spv.h\"")
      set(FLOWDLO_PLAIN_WORDS "${name}_plain_words")
    endif()
    add_custom_command(
      OUTPUT "${folder}/${name}.spv.h"
      COMMAND ${compile} -o "${folder}/${name}.spv" "${shader}"
      ${validate}
      ${plain}
      COMMAND ${compile} --vn ${name}_words -o "${folder}/${name}.spv.h" "${shader}"
      BYPRODUCTS ${plain_words}
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
