#include "field/axes.hpp"

namespace flowdlo::field {

Axes axes(const StrandField& seen) {
  Axes result{axis_lines(seen.channels), width_px(seen), seen.region.magnified_for_px(),
              FieldView(seen), seen.links};
  for (AxisLine& line : result.lines) {
    for (Eigen::Vector2f& point : line.points_px) point = seen.region.to_frame(point);
  }
  return result;
}

}  // namespace flowdlo::field
