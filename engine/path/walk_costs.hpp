// Walk costs: what a way through the strands pays where it ends and for what it leaves out.
#pragma once

#include <algorithm>

#include "path/energy.hpp"
#include "path/strands.hpp"

namespace flowdlo::path {

inline constexpr float kEndAtCrossing = 1.5F;  ///< an end that lies on another strand
inline constexpr float kEndAtCut = 1.0F;       ///< an end where an occluder begins
inline constexpr float kLeftOutCost = 1.5F;    ///< each width of a mask's strand that is left out
inline constexpr float kLooseTip = 1.0F;       ///< a branch left out though it ends in a tip
inline constexpr float kMinorWidths = 1.5F;    ///< strands below this do not make ways distinct

[[nodiscard]] inline float stop_cost(const StrandEnd& end) {
  return end.tip() ? end.end_cost : kEndAtCrossing;
}

/// How wide a field's strand is, by both of its ends; no less than lengths are measured in.
[[nodiscard]] inline float width_px_of(const Strand& strand, const Strands& strands) {
  const float sum = strand.ends[0].look.width_px + strand.ends[1].look.width_px;
  const bool known = strand.ends[0].look.width_px > 0 && strand.ends[1].look.width_px > 0;
  return known ? std::max(kLeastScalePx, 0.5F * sum) : strands.scale_px;
}

[[nodiscard]] inline float left_out_cost(const Strand& strand, const Strands& strands) {
  if (strands.seen != nullptr) {
    return kLeftOutEnergy * strand.covers_px / width_px_of(strand, strands);
  }
  float cost = kLeftOutCost * strand.covers_px / strands.scale_px;
  const bool loose = strand.ends[0].tip() != strand.ends[1].tip();
  if (loose) cost += kLooseTip;
  return cost;
}

}  // namespace flowdlo::path
