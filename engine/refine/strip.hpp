// Strip: what mask and depth show along a centerline and beside it, straightened out, and what is
// known about its nodes: what the refining network is given.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "flowdlo/centerline.hpp"
#include "flowdlo/frame.hpp"
#include "weights/refine_weights.hpp"

namespace flowdlo::refine {

inline constexpr int kStationsOfNode = 4;
inline constexpr int kStations = kStationsOfNode * kNodes;  ///< evenly between the nodes
inline constexpr int kAcross = 16;                          ///< places across at each station
inline constexpr float kAcrossSpacing = 0.25F;              ///< between those, widths of the rope

/// Columns of a station: of each of these its places across, then what follows.
enum Across {
  kDepthOnMask,  ///< measured less the station's, plus a radius, in radii; 0 where not measured
  kDepthBeside,  ///< the same off the mask
  kMasked,       ///< 1 on the mask
  kMeasured,     ///< 1 where a depth was measured
  kAcrossPlanes,
};
enum Column {
  kTurn = kAcrossPlanes * kAcross,  ///< of the image curve at the station, radians
  kSlope,                           ///< sine of the angle between rope and image plane
  kStep,                            ///< pixels between stations: log2 of widths, / 4
  kInside,                          ///< 1 within the image
  kGround,       ///< asinh of how much deeper what lies beside the rope is, in radii, / 2
  kGroundSides,  ///< 0, 0.5 or 1: on neither side, on one or on both is something seen
  kSigma,        ///< of the node that the station belongs to, as all that follow
  kUnseen,       ///< along the rope to a node with support, 20 radii
  kUnsupported,
  kFromMiddle,  ///< 0 in the rope's middle, 1 at its ends
  kNearEnd,
  kPixel,      ///< logarithms of what a pixel spans,
  kNoise,      ///< of the depths' noise,
  kLength,     ///< of the rope's length
  kRadius,     ///< and radius,
  kWidth,      ///< of its width in pixels,
  kDistance,   ///< and of the node's depth
  kThickness,  ///< radius by length
  kBendDeep,   ///< second difference of the nodes, radii
  kBendAlong,
  kBendAside,
  kTable,        ///< asinh of the way to the table (refine/table.hpp), in radii, / 2; as all that
                 ///< follow 0 where there is none
  kTableOff,     ///< the same in misfits of the table at that distance, / 3
  kTableMisfit,  ///< logarithms of that misfit in radii
  kTableDepths,  ///< and of the inverse depths' misfit
  kTableRough,   ///< the table's roughness in misfits
  kTableKnown,   ///< Table::known
  kTableSeen,    ///< share of nodes with support
  kTableNear,    ///< share of those that are nearer to it than 2.5 misfits, or than a radius
  kTableMedian,  ///< of their kTableOff
  kTableSpread,  ///< deviation of those, robust
  kColumnsUsed,
};

/// A hypothesis and what is known about it.
struct Curve {
  Centerline nodes{};
  std::array<float, kNodes> sigma_m{};   ///< the prior's own
  std::array<float, kNodes> unseen_m{};  ///< along the rope to the nearest node with support
  float radius_m = 0;                    ///< of the rope
  float pixel_m = 0;                     ///< what a pixel spans at the rope's depth
  float noise_m = 0;                     ///< standard deviation of the depths on the mask
};

[[nodiscard]] constexpr std::array<float, kNodes> no_table() {
  std::array<float, kNodes> share{};
  share.fill(1);
  return share;
}

struct Strip {
  std::vector<float> values;  ///< [kStations, weights::kRefineInputs], zero beyond kColumnsUsed
  /// What to multiply each node by, along its ray, for the rope to lie on the table there; 1
  /// without a table, and where less than a quarter of the nodes with support are near it.
  std::array<float, kNodes> table_share = no_table();
};

/// Whether its nodes are in front of the camera and the rope has a width.
[[nodiscard]] bool can_be_seen(const Curve& curve);

/// Nothing of a curve that cannot be seen.
[[nodiscard]] std::optional<Strip> strip_along(const Curve& curve, const Frame& frame);

}  // namespace flowdlo::refine
