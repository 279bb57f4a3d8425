// Whether a mask is one rope, the whole of it, and explained by the nodes.
#pragma once

#include "flowdlo/estimate.hpp"
#include "flowdlo/frame.hpp"

namespace flowdlo::gate {

/// Where a doubt begins. Chosen on training scenes (flowdlo-lab one-rope-report --csv), of which
/// 255 of the wide split and 55 drawn ones have an estimate that is right (under 1 cm); "right
/// ones" are these.
struct OneRopeLimits {
  float slender = 5;          ///< widths; shorter is no rope. Right ones from 10, discs up to 2
  float sides = 0.25F;        ///< share; less is no rope. Right ones from 0.80, full masks 0
  float explained = 0.7F;     ///< share; less leaves strands out. Right ones from 0.92
  float left_over = 6;        ///< widths, and
  float left_share = 0.04F;   ///< of the curve; more are strands. 99 % of the right ones to 0.03
  float bare_gap = 2.5F;      ///< widths, and
  float bare_share = 0.025F;  ///< of the curve; more is a jump. 99 % of the right ones to 0.022
  float goes_on = 2.5F;       ///< widths; from here on the mask is cut off. Right ones to 1.5
};

/// Expects a valid frame. `rope_width_px` is path::Traversals'.
[[nodiscard]] OneRope one_rope(const Centerline& nodes, const Frame& frame, float rope_width_px,
                               const OneRopeLimits& limits = {});

/// At most this is the confidence of an estimate with a doubt.
inline constexpr float kDoubted = 0.25F;

/// `confidence` as its doubts leave it.
[[nodiscard]] float doubted(float confidence, const OneRope& one);

}  // namespace flowdlo::gate
