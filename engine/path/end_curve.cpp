#include "path/end_curve.hpp"

#include <algorithm>
#include <cmath>

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;

constexpr float kNearestWidths = 0.5F;  // ends nearer than this have no curve between them

}  // namespace

EndCurve end_curve(const StrandEnd& from, const StrandEnd& to, float leaves, float enters,
                   float scale_px, bool from_own) {
  EndCurve curve;
  const float chord_px = (to.point_px - from.point_px).norm();
  curve.cubic = {from.point_px, to.point_px, leaves * chord_px * from.heading,
                 -enters * chord_px * to.heading};
  float energy = 0;
  for (int i = 0; i < kCurveSamples; ++i) {
    const float t = sample_t(i);
    const Vector2f d1 = curve.cubic.first_derivative(t);
    const Vector2f d2 = curve.cubic.second_derivative(t);
    const float speed = std::max(d1.norm(), 1e-3F);
    float bend = (d1.x() * d2.y() - d1.y() * d2.x()) / (speed * speed * speed);
    if (from_own) bend -= (1 - t) * from.curvature - t * to.curvature;
    curve.steps[i] = speed / kCurveSamples;
    curve.length_px += curve.steps[i];
    energy += bend * bend * curve.steps[i];
  }
  curve.bending = energy * curve.length_px;
  if (chord_px < kNearestWidths * scale_px) {
    const float turn = std::acos(std::clamp(-from.heading.dot(to.heading), -1.0F, 1.0F));
    curve.bending = turn * turn;
  }
  return curve;
}

}  // namespace flowdlo::path
