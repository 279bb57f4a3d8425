// Walk costs: what a way through the strands pays where it ends and for what it leaves out.
#pragma once

#include "path/bonds.hpp"
#include "path/strands.hpp"

namespace flowdlo::path {

inline constexpr float kEndAtCrossing = 1.5F;  ///< an end that lies on another strand
inline constexpr float kEndAtCut = 1.0F;       ///< an end where an occluder begins
inline constexpr float kLooseTip = 1.0F;       ///< a branch left out though it ends in a tip
inline constexpr float kMinorWidths = 1.5F;    ///< strands below this do not make ways distinct

[[nodiscard]] inline float stop_cost(const StrandEnd& end) {
  return end.tip() ? end.end_cost : kEndAtCrossing;
}

[[nodiscard]] inline float left_out_cost(const Strand& strand, const Strands& strands) {
  float cost = strands.left_out_cost * strand.covers_px / strands.scale_px;
  const bool loose = strand.ends[0].tip() != strand.ends[1].tip();
  if (loose) cost += kLooseTip;
  return cost;
}

}  // namespace flowdlo::path
