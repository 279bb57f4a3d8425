# flowdlo_api_pages: the API reference by Doxygen, where it is installed; build/.../api_pages/html.
# flowdlo_site: the project's pages with it, where mkdocs is installed too; build/.../site/index.html.
find_package(Doxygen QUIET)
if(NOT DOXYGEN_FOUND)
  return()
endif()
set(FLOWDLO_DOXYGEN
    "${CMAKE_COMMAND}" -E env "FLOWDLO_SOURCE=${PROJECT_SOURCE_DIR}"
    "FLOWDLO_HEADERS=${PROJECT_BINARY_DIR}/include" "FLOWDLO_REFERENCE=${PROJECT_BINARY_DIR}/api_pages"
    "${DOXYGEN_EXECUTABLE}" "${PROJECT_SOURCE_DIR}/docs/Doxyfile")
add_custom_target(flowdlo_api_pages
                  COMMAND "${CMAKE_COMMAND}" -E make_directory "${PROJECT_BINARY_DIR}/api_pages"
                  COMMAND ${FLOWDLO_DOXYGEN} VERBATIM)

find_program(FLOWDLO_MKDOCS mkdocs)
if(FLOWDLO_MKDOCS)
  add_custom_target(flowdlo_site
                    COMMAND "${PROJECT_SOURCE_DIR}/scripts/site" "${PROJECT_BINARY_DIR}/site"
                            "${PROJECT_BINARY_DIR}/api_pages/html" VERBATIM)
  add_dependencies(flowdlo_site flowdlo_api_pages)
endif()
