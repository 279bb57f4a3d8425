#include "gate/image_curve.hpp"

#include <algorithm>
#include <cmath>

#include "gate/tube_score.hpp"
#include "geometry/camera.hpp"
#include "geometry/polyline.hpp"

namespace flowdlo::gate {
namespace {

using Eigen::Vector2f;

constexpr float kLeastDepth_m = 1e-6F;  // Sec. 3.2
constexpr float kSpacing = 0.25F;       // between samples, widths
constexpr float kMostWider = 3;         // a radius, against half the mask's width
constexpr float kFarthest = 4;          // outside the image, in its sizes

bool drawable(const Centerline& nodes, const Frame& frame) {
  const float most = kFarthest * static_cast<float>(std::max(frame.width, frame.height));
  return geometry::all_finite(nodes) && std::all_of(nodes.begin(), nodes.end(), [&](const auto& p) {
           return p.z > kLeastDepth_m &&
                  geometry::project(frame.intrinsics, p).cwiseAbs().maxCoeff() < most;
         });
}

}  // namespace

ImageCurve image_curve(const Centerline& nodes, const Frame& frame, float rope_width_px) {
  ImageCurve curve;
  if (!drawable(nodes, frame)) return curve;
  curve.width_px = std::max(1.0F, rope_width_px);
  curve.radius_m = tube_radius_m(nodes, frame.intrinsics, rope_width_px);
  const float spacing_px = std::max(1.0F, kSpacing * curve.width_px);
  float length_px = 0;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const Vector2f from = geometry::project(frame.intrinsics, nodes[i]);
    const Vector2f step = geometry::project(frame.intrinsics, nodes[i + 1]) - from;
    const float step_px = step.norm();
    if (step_px <= 0) continue;
    const int pieces = std::max(1, static_cast<int>(std::lround(step_px / spacing_px)));
    const bool last = i + 2 == nodes.size();
    for (int k = 0; k < pieces + (last ? 1 : 0); ++k) {
      const float t = static_cast<float>(k) / static_cast<float>(pieces);
      const float depth_m = (1 - t) * nodes[i].z + t * nodes[i + 1].z;
      const float radius_px = std::min(kMostWider * 0.5F * curve.width_px,
                                       curve.radius_m * frame.intrinsics.fx / depth_m);
      curve.points.push_back(
          {from + t * step, step / step_px, depth_m, radius_px, length_px + t * step_px});
    }
    length_px += step_px;
  }
  return curve;
}

}  // namespace flowdlo::gate
