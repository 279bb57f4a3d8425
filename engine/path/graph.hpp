// Graph: the skeleton as segments between tips and junctions, spurs pruned by the local width.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "path/region.hpp"

namespace flowdlo::path {

/// A stretch of skeleton between two nodes; points one pixel apart, in crop coordinates. An end
/// is numbered 2 * segment + side, side 0 at points.front().
struct Segment {
  std::vector<Eigen::Vector2f> points_px;
  std::array<int, 2> node{-1, -1};  ///< at each side; both -1: a ring, cut open
  float length_px = 0;
  bool alive = true;

  [[nodiscard]] bool ring() const { return node[0] < 0; }
};

struct Node {
  Eigen::Vector2f position_px{0, 0};
  float distance_px = 0;  ///< to the nearest empty pixel
  std::vector<int> ends;  ///< segment ends that meet here; one: a tip
};

struct Graph {
  std::vector<Node> nodes;
  std::vector<Segment> segments;  ///< those not alive have been pruned or merged away
  float width_px = 1;             ///< of one strand, usual over the skeleton
  int pruned = 0;                 ///< how many spurs went

  /// Whether a segment's side is a free end.
  [[nodiscard]] bool at_tip(const Segment& segment, int side) const {
    return !segment.ring() && nodes[segment.node[side]].ends.size() == 1;
  }
};

/// Segments that the graph of `mask` (0 or 1, its outermost pixels 0) has at least:
/// Euler's formula says by how many they exceed its nodes, which is by how many its holes exceed
/// its pieces. One pass over the mask.
[[nodiscard]] int least_segments(const image::Mask& mask);

/// The pruned graph of the skeleton `thinned` of `region`; may hold no segment.
[[nodiscard]] Graph make_graph(const image::Mask& thinned, const Region& region);

}  // namespace flowdlo::path
