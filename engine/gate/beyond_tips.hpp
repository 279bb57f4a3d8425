// BeyondTips: whether the rope is seen going on where the mask ends.
#pragma once

#include "flowdlo/frame.hpp"
#include "gate/image_curve.hpp"

namespace flowdlo::gate {

/// How far beyond the mask a ridge as wide as the rope and at its depth goes on from
/// either end of the curve: the longer of both, widths, at most kFarthestBeyond.
[[nodiscard]] float beyond_tips(const ImageCurve& curve, const Frame& frame);

inline constexpr float kFarthestBeyond = 12;

}  // namespace flowdlo::gate
