// Crossings: which junctions of the skeleton are one crossing, and what lies inside it.
#pragma once

#include <vector>

#include "path/graph.hpp"

namespace flowdlo::path {

/// Two forks with a bridge that both strands share are one crossing, and so are junctions nearer
/// than the rope is wide.
class Crossings {
 public:
  Crossings(const Graph& graph, const image::Image<float>& distance_px, float scale_px);

  /// The crossing that the node belongs to.
  [[nodiscard]] int of(int node) const { return crossing_[node]; }
  /// True when the segment lies inside a crossing.
  [[nodiscard]] bool inner(int segment) const { return inner_[segment]; }

 private:
  std::vector<int> crossing_;
  std::vector<bool> inner_;
};

}  // namespace flowdlo::path
