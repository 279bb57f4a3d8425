// StripShape: whether the mask along a curve is a strip as wide as the rope.
#pragma once

#include "flowdlo/frame.hpp"
#include "gate/image_curve.hpp"

namespace flowdlo::gate {

struct StripShape {
  float sides = 0;  ///< [0, 1] share of the curve on the mask beside which the mask ends in sight
  float even = 0;   ///< [0, 1] share of the places with two such sides as wide as the rope
  float widening = 1;  ///< [1, 2.5] median width of the mask at these places, in the rope's widths
  float off_mask = 0;  ///< [0, 1] share of the curve off the mask where nothing hides it
  float bare_gap_widths = 0;  ///< longest stretch of the curve where depth shows what is behind it
};

/// Linear in the curve's length times the rope's width. `curve` is not empty.
[[nodiscard]] StripShape strip_shape(const ImageCurve& curve, const Frame& frame);

}  // namespace flowdlo::gate
