// EndLook: what a strand looks like near one of its ends, by which a rope is known again beyond a
// gap.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "field/view.hpp"
#include "flowdlo/frame.hpp"
#include "path/region.hpp"

namespace flowdlo::path {

struct EndLook {
  float width_px = 0;                  ///< that the strand field shows; 0: unknown
  Eigen::Vector3f color_bgr{0, 0, 0};  ///< 0 to 255, in the median
  float color_spread = -1;             ///< around it, in the median; below 0: no colour
};

/// Of the end at the front of `points`, a pixel apart: of what lies one to nine widths behind it,
/// or of the inner half of what there is.
[[nodiscard]] EndLook look_of(const std::vector<Eigen::Vector2f>& points, float scale_px,
                              const Region& region, const Frame& frame,
                              const field::FieldView& seen);

/// [0, 1) how much another colour one has than the other, whatever light falls on either; 0 where
/// that is not known. Grey and white are one colour.
[[nodiscard]] float color_misfit(const EndLook& a, const EndLook& b);

}  // namespace flowdlo::path
