// Stations: how wide the mask is across the lines of the graph, and how wide one strand is.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "path/graph.hpp"
#include "path/region.hpp"

namespace flowdlo::path {

/// How finely `reach` walks.
inline constexpr float kScanStepPx = 0.25F;
/// And how far to each side, in usual widths, where strands may lie beside each other.
inline constexpr float kMostScan = 2.2F;
/// Times nearer or farther than what is usual: else no rope.
inline constexpr float kNearerMost = 2.5F;

/// Across a line at one of its points.
struct Station {
  Eigen::Vector2f middle_px{0, 0};  ///< of the mask
  Eigen::Vector2f normal{0, 0};     ///< to its left
  float width_px = 0;
  float nearer = 1;   ///< how many times larger things look than where the rope usually is
  float size_px = 0;  ///< the width there
  bool whole = true;  ///< no occluder hides a side

  [[nodiscard]] Eigen::Vector2f edge(float side) const {
    return middle_px + 0.5F * side * width_px * normal;
  }
};

/// One station for each of a segment's points; empty where the segment is gone.
using Line = std::vector<Station>;

/// Of the graph's segments, in their order.
[[nodiscard]] std::vector<Line> stations_of(const Graph& graph, const Region& region,
                                            const Frame& frame);

/// What lies across a line at its point `p`, where it runs `along`; no width where that is no
/// direction. Scans at most `most_px` to each side.
[[nodiscard]] Station across(const image::Mask& mask, const Eigen::Vector2f& p,
                             const Eigen::Vector2f& along, float most_px);

/// The size of one strand; 0 where nothing tells it. `usual_px` is the rope's usual width.
[[nodiscard]] float single_size(const std::vector<Line>& lines, float usual_px);

/// A step of a line to a side.
struct Aside {
  float px = 0;
  float sigma_px = 0;  ///< its standard error; 0: nothing is known
};

/// How far a line steps aside where it goes on as another: both are fitted as one parabola with a
/// step, each from its first point on, near the step, away from it. Along `left`, from `before` to
/// `after`; nothing where either has fewer than three points.
[[nodiscard]] Aside step_aside(const std::vector<Eigen::Vector2f>& before,
                               const std::vector<Eigen::Vector2f>& after,
                               const Eigen::Vector2f& left);

/// How far `mask` reaches from `p` along the unit vector `direction`, at most `most_px`.
[[nodiscard]] float reach(const image::Mask& mask, const Eigen::Vector2f& p,
                          const Eigen::Vector2f& direction, float most_px);

}  // namespace flowdlo::path
