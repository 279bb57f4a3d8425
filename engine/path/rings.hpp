// Rings: where the rope of a closed line begins. Its ends lie beside each other there, and the mask
// is wider for a while; or they touch, and leave a notch.
#pragma once

#include "path/graph.hpp"
#include "path/region.hpp"

namespace flowdlo::path {

/// Cuts the rings of `graph` open where their ends show. Where these lie beside each other, the
/// line passes there twice, once along each. A ring that does not show its ends stays as it is.
void open_rings(Graph& graph, const Region& region);

}  // namespace flowdlo::path
