# flowdlo_compile_together(FOLDER ...): with FLOWDLO_UNITY the files of each target in these folders, and
# in those below, are compiled several at a time: the headers that they share are read and instantiated
# once. A file's own helpers lie in a namespace without a name. Two files that name one alike are put
# apart, so that nobody has to know what the others are called. What is not seen here, such as a helper
# named as something in another file's header, is an error of the compiler: rename it.
# Files of the global property FLOWDLO_WATCHED are kept apart from the others, in objects whose name
# says so: tests/races compiles them itself and leaves those objects out. Of a target whose property
# FLOWDLO_FILES_ALONE is set, each file is compiled alone.

# Of the files of a target, as many as a processor compiles in some 10 s.
set(FLOWDLO_FILES_TOGETHER 10)

# names: what `file` declares from the first column on. Too many do no harm.
function(flowdlo_names_in names file)
  file(READ "${file}" text)
  string(REPLACE ";" "@" text "${text}")  # lists end there
  string(REGEX REPLACE "[][]" "(" text "${text}")
  string(REGEX REPLACE "\n(namespace|template|extern|using) [^\n]*" "\n" text "${text}")
  set(found)
  string(REGEX MATCHALL "\n(struct|class|union|enum|enum class) [A-Za-z0-9_]+" lines "${text}")
  string(REGEX MATCHALL "\n[a-zA-Z][^\n({=@]*[ *&>][A-Za-z0-9_]+ *[({=@]" more "${text}")
  foreach(line IN LISTS lines more)
    string(REGEX MATCH "([A-Za-z0-9_]+) *[({=@]?$" name "${line}")
    list(APPEND found "${CMAKE_MATCH_1}")
  endforeach()
  list(REMOVE_DUPLICATES found)
  set(${names} "${found}" PARENT_SCOPE)
endfunction()

function(flowdlo_group_files target)
  get_target_property(alone ${target} FLOWDLO_FILES_ALONE)
  get_target_property(type ${target} TYPE)
  get_target_property(sources ${target} SOURCES)
  if(alone OR NOT sources OR NOT type MATCHES "EXECUTABLE|LIBRARY")
    return()
  endif()
  get_target_property(folder ${target} SOURCE_DIR)
  get_property(watched GLOBAL PROPERTY FLOWDLO_WATCHED)
  set(groups_files 0)
  set(groups_watched 0)
  foreach(source IN LISTS sources)
    get_filename_component(file "${source}" ABSOLUTE BASE_DIR "${folder}")
    if(NOT file MATCHES "[.]cpp$" OR NOT EXISTS "${file}")  # made while building
      continue()
    endif()
    string(FIND "${file}" "${folder}/" begins)
    if(type STREQUAL "STATIC_LIBRARY" AND NOT begins EQUAL 0)
      continue()  # borrowed: who has its own must not get this one with the archive's other files
    endif()
    flowdlo_names_in(names "${file}")
    set(kind files)
    if(file IN_LIST watched)
      set(kind watched)
    endif()
    set(group 0)
    while(group LESS groups_${kind})
      list(LENGTH ${kind}_${group} count)
      set(rest ${names_${kind}_${group}})
      list(REMOVE_ITEM rest ${names} "")
      list(LENGTH names_${kind}_${group} before)
      list(LENGTH rest after)
      if(count LESS FLOWDLO_FILES_TOGETHER AND before EQUAL after)
        break()
      endif()
      math(EXPR group "${group} + 1")
    endwhile()
    if(group EQUAL groups_${kind})
      math(EXPR groups_${kind} "${group} + 1")
    endif()
    list(APPEND ${kind}_${group} "${file}")
    list(APPEND names_${kind}_${group} ${names})
    set_source_files_properties("${file}" TARGET_DIRECTORY ${target}
                                PROPERTIES UNITY_GROUP "${kind}_${group}")
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  set_property(GLOBAL APPEND PROPERTY FLOWDLO_TOGETHER ${target})
endfunction()

function(flowdlo_compile_together)
  if(NOT FLOWDLO_UNITY)
    return()
  endif()
  foreach(folder IN LISTS ARGN)
    get_property(targets DIRECTORY "${folder}" PROPERTY BUILDSYSTEM_TARGETS)
    foreach(target IN LISTS targets)
      flowdlo_group_files(${target})
    endforeach()
    get_property(below DIRECTORY "${folder}" PROPERTY SUBDIRECTORIES)
    if(below)
      flowdlo_compile_together(${below})
    endif()
  endforeach()
endfunction()

# flowdlo_check_together(): an error where FLOWDLO_UNITY is set and no target's files are compiled together.
function(flowdlo_check_together)
  get_property(targets GLOBAL PROPERTY FLOWDLO_TOGETHER)
  if(FLOWDLO_UNITY AND NOT targets)
    message(FATAL_ERROR "FLOWDLO_UNITY: expected targets whose files are compiled together, got none")
  endif()
endfunction()
