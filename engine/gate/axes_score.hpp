// AxesScore: how well a curve agrees with the strands that a field shows.
#pragma once

#include "field/axes.hpp"
#include "gate/image_curve.hpp"

namespace flowdlo::gate {

/// Shares in [0, 1]. A curve runs along an axis where it is within half a rope's width of it and
/// within 30 degrees of its direction. All zero where no field was asked.
struct AxesScore {
  bool known = false;  ///< a field was asked
  float followed = 0;  ///< of the axes' length, that which the curve runs along
  float backed = 0;    ///< of the curve's length, that which runs along an axis
  float twice = 0;     ///< of the axes' length, that which the curve runs along more than once
  float tips_met = 0;  ///< mean over both ends of how much like a rope's end the field looks there
  float tips_left =
      0;  ///< half of the sum of that over the axes' ends where the curve does not end
};

/// All zero but `known` for a curve without points.
[[nodiscard]] AxesScore score_axes(const field::Axes& axes, const ImageCurve& curve);

}  // namespace flowdlo::gate
