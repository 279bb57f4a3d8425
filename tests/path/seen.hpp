// Seen: strands in a mask, and what a perfect network says of them.
#pragma once

#include <cmath>
#include <vector>

#include "canvas.hpp"
#include "field/strand_field.hpp"
#include "path/strand_reading.hpp"
#include "support/painted_field.hpp"

namespace flowdlo::test {

/// An axis in whole pixels.
inline Curve curve_of(const testing::Axis& axis) {
  Curve curve;
  for (const Eigen::Vector2f& p : axis) {
    curve.emplace_back(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
  }
  return curve;
}

/// A rope of 8 px in a frame of 320 x 240, seen one to one, whose mask is as `axes` drawn `mask_px`
/// wide.
struct Seen {
  Canvas canvas{320, 240};
  field::StrandField field;

  explicit Seen(const std::vector<testing::Axis>& axes, int mask_px = 9) {
    for (const testing::Axis& axis : axes) {
      const Curve curve = curve_of(axis);
      canvas.stroke(curve, mask_px).depth(curve, mask_px, 0.5F);
    }
    field.region = {{0, 0, 320, 240}, {320, 240}, {1, 1}};
    field.channels = testing::painted_field(axes, {320, 240});
  }
  [[nodiscard]] Result<path::Traversals> traced() const {
    return path::trace_strands(canvas.frame(), field::axes(field));
  }
};

}  // namespace flowdlo::test
