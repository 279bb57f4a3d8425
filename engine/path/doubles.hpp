// Doubles: where two strands lie beside each other in the mask, as its width alone tells.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "path/graph.hpp"
#include "path/region.hpp"

namespace flowdlo::path {

/// What `find_doubles` found.
struct Doubles {
  std::vector<std::vector<Eigen::Vector2f>> lines;  ///< crop coordinates; empty: no strands touch
  float width_px = 0;                               ///< of one strand
};

/// Lines between strands that touch: along stretches of the graph two ropes wide, on to where the
/// strands part, or to the step where one of them stops beside the other. Where the stretch ends in
/// a tip the strand turns back, and the line stops a width short of it. Only masks whose narrow
/// parts and wide parts are well apart tell.
[[nodiscard]] Doubles find_doubles(const Graph& graph, const Region& region, const Frame& frame);

}  // namespace flowdlo::path
