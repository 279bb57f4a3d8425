// Strands: the segments between crossings, each cut back to where its direction can be trusted.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "field/view.hpp"
#include "path/end_look.hpp"
#include "path/energy.hpp"
#include "path/graph.hpp"
#include "weights/link_weights.hpp"

namespace flowdlo::path {

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
  EndLook look{};                 ///< of the strand near it
  int crossing = -1;              ///< the crossing it runs into; -1: a tip
  int node = -1;                  ///< the graph's node there
  Eigen::Vector2f fork_px{0, 0};  ///< middle of the points of all ends at that node

  [[nodiscard]] bool tip() const { return crossing < 0; }
};

/// A stretch of one rope between tips and crossings. Its ends are numbered 2 * strand + side.
struct Strand {
  std::vector<Eigen::Vector2f> points_px;  ///< smoothed, from side 0 to side 1, crop coordinates
  std::array<StrandEnd, 2> ends;
  float covers_px = 0;  ///< length that a path wins by using it
  bool ring = false;    ///< closed: no tips, and nothing can be linked to it
};

/// What two strands of the mask share: what lies inside crossings.
struct Bridge {
  std::vector<Eigen::Vector2f> points_px;
  std::array<int, 2> node{-1, -1};
};

struct Strands {
  std::vector<Strand> list;
  std::vector<Bridge> bridges;
  float width_px = 1;    ///< the rope's
  float scale_px = 1;    ///< the width, but no less than four pixels: what lengths are measured in
  bool several = false;  ///< there may be more than one rope
  const field::FieldView* seen =
      nullptr;  ///< of a strand field's: what it shows beside them; or null
  const weights::LinkWeights* links = nullptr;  ///< and the network that links them; or null

  [[nodiscard]] const StrandEnd& end(int id) const { return list[id / 2].ends[id % 2]; }
};

/// Strands below so many widths do not make ways distinct.
inline constexpr float kMinorWidths = 1.5F;

/// How wide a strand is, by both of its ends; no less than lengths are measured in.
[[nodiscard]] float width_px_of(const Strand& strand, const Strands& strands);

/// What lengths between two ends are measured in: how wide the strands are there, for ropes differ,
/// and so do the near and the far end of one; pixels.
[[nodiscard]] float scale_between(const StrandEnd& a, const StrandEnd& b, const Strands& strands);

/// Energy of a way that leaves the strand out.
[[nodiscard]] float left_out_energy(const Strand& strand, const Strands& strands);

/// What a path pays that ends there, and what that comes of. `goes_on` is [0, 1] how likely another
/// reading goes on from there to another strand.
[[nodiscard]] StopTerms stop_terms(const StrandEnd& end, float goes_on = 0);

/// A stretch of one strand as a strand field shows it: crop coordinates.
struct Stretch {
  std::vector<Eigen::Vector2f> points_px;  ///< about one pixel apart, two at least
  std::array<float, 2> tips{0, 0};         ///< [0, 1] how much like the rope's own end each looks
  bool closed = false;
};

/// Stretches as strands that meet nowhere: where one ends that is no tip, its rope goes on below
/// another strand or an occluder, as a link. Only what lies on the mask is won by using it. What
/// `seen` shows is what the stretches were found in; it lives on.
[[nodiscard]] Strands make_strands(const std::vector<Stretch>& stretches, float width_px,
                                   const Region& region, const Frame& frame,
                                   const field::FieldView& seen);

/// The mask's own strands: crossings are formed (two forks with a bridge that both strands share
/// count as one), strands are trimmed and measured. `frame` gives the depth.
[[nodiscard]] Strands make_strands(const Graph& graph, const Region& region, const Frame& frame);

}  // namespace flowdlo::path
