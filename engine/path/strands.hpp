// Strands: the segments between crossings, each cut back to where its direction can be trusted.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "field/view.hpp"
#include "path/end_look.hpp"
#include "path/graph.hpp"

namespace flowdlo::path {

/// What one more rope of the mask's own strands costs beside where its two ends lie, dimensionless
/// as Bond::cost. A gap that costs more parts two ropes, and what is left out for less is no rope:
/// a stretch of two widths. Chosen on drawn scenes (flowdlo-lab ropes-report): below 2, ropes that
/// gaps part fall to pieces; from 6 on, ropes that cross flatly are joined.
inline constexpr float kRopeCost = 3.5F;

/// And one more ring, which has no ends.
inline constexpr float kRingCost = 1.0F;

/// Lengths are measured in the rope's width, but in no less than this.
inline constexpr float kLeastScalePx = 4.0F;

/// One end of a strand, outside the zone that a crossing or a tip distorts.
struct StrandEnd {
  Eigen::Vector2f point_px{0, 0};
  Eigen::Vector2f outward{0, 0};  ///< unit tangent, away from the strand
  float depth_m = 0;              ///< of the visible surface at `point_px`; 0: unknown
  float slope_per_px = 0;         ///< change of depth along `outward`
  Eigen::Vector2f heading{0, 0};  ///< `outward`, turned on by the curvature to the very end
  float curvature = 0;            ///< 1 / px, along `outward`; positive from x to y
  bool cut = false;               ///< right behind it something nearer hides the rope
  bool leaves = false;            ///< the image ends where it does
  float tip_seen = 0;             ///< [0, 1] how much the strand field shows the rope's own end
  float goes_on = 0;              ///< [0, 1] how likely another reading goes on to another strand
  float end_cost = 0;             ///< what a path pays that ends here, where it is a tip
  EndLook look{};                 ///< of the strand, where a field shows it
  int crossing = -1;              ///< the crossing it runs into; -1: a tip
  int node = -1;                  ///< the graph's node there
  Eigen::Vector2f node_px{0, 0};  ///< and where it is
  Eigen::Vector2f fork_px{0, 0};  ///< middle of the points of all ends at that node

  [[nodiscard]] bool tip() const { return crossing < 0; }
};

/// A stretch of one rope between tips and crossings. Its ends are numbered 2 * strand + side.
struct Strand {
  std::vector<Eigen::Vector2f> points_px;  ///< smoothed, from side 0 to side 1, crop coordinates
  std::array<StrandEnd, 2> ends;
  float covers_px = 0;   ///< length that a path wins by using it
  bool ring = false;     ///< closed: no tips, and nothing can be linked to it
  bool opened = false;   ///< a ring, but its rope's ends show where it begins
  bool doubled = false;  ///< between crossings and too wide for one rope: a second one lies on it
};

/// What two strands share: what lies inside crossings, and doubled strands once more.
struct Bridge {
  std::vector<Eigen::Vector2f> points_px;
  std::array<int, 2> node{-1, -1};
  float narrowest_px = 0;  ///< width of the mask where it is least
};

struct Strands {
  std::vector<Strand> list;
  std::vector<Bridge> bridges;
  float width_px = 1;  ///< the rope's
  float scale_px = 1;  ///< the width, but no less than four pixels: what lengths are measured in
  float rope_cost = kRopeCost;  ///< of one more rope, beside what its ends cost
  float ring_cost = kRingCost;  ///< and of a ring, which has none
  const field::FieldView* seen =
      nullptr;  ///< of a strand field's: what it shows beside them; or null

  [[nodiscard]] const StrandEnd& end(int id) const { return list[id / 2].ends[id % 2]; }
};

/// A stretch of one strand as a strand field shows it: crop coordinates.
struct Stretch {
  std::vector<Eigen::Vector2f> points_px;  ///< about one pixel apart, two at least
  std::array<float, 2> tips{0, 0};         ///< [0, 1] how much like the rope's own end each looks
  bool closed = false;
};

/// Stretches as strands that meet nowhere: where one ends that is no tip, its rope goes on below
/// another strand or an occluder, as a link. Only what lies on the mask is won by using it. What it
/// costs to stop at an end is not known here.
[[nodiscard]] Strands make_strands(const std::vector<Stretch>& stretches, float width_px,
                                   const Region& region, const Frame& frame);

/// Crossings are formed (two forks with a bridge that both strands share count as one), strands
/// are trimmed and measured. `frame` gives the depth.
[[nodiscard]] Strands make_strands(const Graph& graph, const Region& region, const Frame& frame);

}  // namespace flowdlo::path
