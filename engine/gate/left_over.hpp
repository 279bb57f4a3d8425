// LeftOver: what of the mask a curve leaves unexplained.
#pragma once

#include "flowdlo/frame.hpp"
#include "gate/image_curve.hpp"

namespace flowdlo::gate {

struct LeftOver {
  float explained = 0;       ///< [0, 1] share of the mask's area near the curve
  float strands_widths = 0;  ///< length of what is left and about as thick as the rope
};

/// Linear in the pixels of the mask's box. `curve` is not empty; `widening` is StripShape's.
[[nodiscard]] LeftOver left_over(const ImageCurve& curve, float widening, const Frame& frame);

}  // namespace flowdlo::gate
