#include "path/end_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;

constexpr float kNearestWidths = 0.5F;  // ends nearer than this have no curve between them

}  // namespace

EndCurve end_curve(const StrandEnd& from, const StrandEnd& to, float leaves, float enters,
                   float scale_px) {
  EndCurve curve;
  const float chord_px = (to.point_px - from.point_px).norm();
  curve.cubic = {from.point_px, to.point_px, leaves * chord_px * from.heading,
                 -enters * chord_px * to.heading};
  const Vector2f chord = curve.cubic.b - curve.cubic.a;
  const Vector2f da = curve.cubic.da;
  const Vector2f db = curve.cubic.db;
  std::array<float, kCurveSamples> bends;
  for (int i = 0; i < kCurveSamples; ++i) {  // without branches, for many at once
    const float t = sample_t(i);
    const SlopeWeights first = first_weights(t);
    const SlopeWeights second = second_weights(t);
    const float x1 = first.chord * chord.x() + first.a * da.x() + first.b * db.x();
    const float y1 = first.chord * chord.y() + first.a * da.y() + first.b * db.y();
    const float x2 = second.chord * chord.x() + second.a * da.x() + second.b * db.x();
    const float y2 = second.chord * chord.y() + second.a * da.y() + second.b * db.y();
    const float speed = std::max(std::sqrt(x1 * x1 + y1 * y1), 1e-3F);
    const float bend = (x1 * y2 - y1 * x2) / (speed * speed * speed);
    bends[i] = bend - ((1 - t) * from.curvature - t * to.curvature);
    curve.steps[i] = speed / kCurveSamples;
  }
  float energy = 0;
  for (int i = 0; i < kCurveSamples; ++i) {
    curve.length_px += curve.steps[i];
    energy += bends[i] * bends[i] * curve.steps[i];
  }
  curve.bending = energy * curve.length_px;
  if (chord_px < kNearestWidths * scale_px) {
    const float turn = std::acos(std::clamp(-from.heading.dot(to.heading), -1.0F, 1.0F));
    curve.bending = turn * turn;
  }
  return curve;
}

}  // namespace flowdlo::path
