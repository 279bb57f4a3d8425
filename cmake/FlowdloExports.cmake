# What libflowdlo.so shows: flowdlo's own FLOWDLO_EXPORTed names and nothing else. Hidden visibility
# alone leaves libstdc++'s template instantiations and whatever static archives bring.
if(BUILD_SHARED_LIBS AND UNIX AND NOT APPLE)
  set(map "${PROJECT_SOURCE_DIR}/cmake/flowdlo.map")
  target_link_options(flowdlo PRIVATE "LINKER:--version-script=${map}")
  set_property(TARGET flowdlo APPEND PROPERTY LINK_DEPENDS "${map}")
endif()
