# flowdlo_agg: Anti-Grain Geometry, with which the command draws. A static library without any other behind it,
# so that nothing is loaded for it at run time. Headers are named with their folder: <agg2/agg_basics.h>.
find_path(FLOWDLO_AGG_INCLUDE_DIR agg2/agg_gsv_text.h REQUIRED
          DOC "Folder of agg2/; Debian and Ubuntu: libagg-dev")
find_library(FLOWDLO_AGG_LIBRARY NAMES agg_pic agg REQUIRED)
mark_as_advanced(FLOWDLO_AGG_INCLUDE_DIR FLOWDLO_AGG_LIBRARY)
add_library(flowdlo_agg INTERFACE)
target_include_directories(flowdlo_agg SYSTEM INTERFACE "${FLOWDLO_AGG_INCLUDE_DIR}")
target_link_libraries(flowdlo_agg INTERFACE "${FLOWDLO_AGG_LIBRARY}")
