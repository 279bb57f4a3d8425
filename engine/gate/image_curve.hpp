// ImageCurve: a centerline as the image shows it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "flowdlo/centerline.hpp"
#include "flowdlo/frame.hpp"

namespace flowdlo::gate {

/// One sample of it.
struct CurvePoint {
  Eigen::Vector2f px{0, 0};
  Eigen::Vector2f along{1, 0};  ///< unit, towards the last node
  float depth_m = 0;            ///< of the axis
  float radius_px = 0;
  float length_px = 0;  ///< along the curve from the first node
};

struct ImageCurve {
  std::vector<CurvePoint>
      points;          ///< a quarter of a width apart, or a pixel; empty: cannot be drawn
  float width_px = 0;  ///< of the rope
  float radius_m = 0;  ///< what half of that means at the curve's depth
};

/// Without points where a node is not finite, not in front of the camera or far outside the image.
/// `rope_width_px` is path::Traversals'.
[[nodiscard]] ImageCurve image_curve(const Centerline& nodes, const Frame& frame,
                                     float rope_width_px);

}  // namespace flowdlo::gate
