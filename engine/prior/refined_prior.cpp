#include "prior/refined_prior.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "geometry/camera.hpp"
#include "geometry/polyline.hpp"
#include "prior/association.hpp"
#include "prior/doubt.hpp"
#include "prior/ends.hpp"
#include "prior/rope_depth.hpp"
#include "prior/strip.hpp"
#include "prior/sunken.hpp"

namespace flowdlo::prior {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kMostWidthPx = 400.0F;
/// The centerline as a fine polyline, with what is known about each of its points.
struct Curve {
  std::vector<Vector3f> points_cam;
  std::vector<float> arclength_px;  // on the strip
  std::vector<float> sigma_m;
};

Curve make_curve(const Strip& strip, const RopeDepth& rope, const Extent& extent, float fx) {
  std::vector<Vector3f> points;
  for (std::size_t i = 0; i < strip.stations.size(); ++i) {
    points.push_back(strip.stations[i].ray * static_cast<float>(rope.axis_m[i]));
  }
  const std::vector<float> sigma_m = station_sigma_m(points, strip, rope, fx);
  Curve curve;
  const auto add = [&](float arclength_px) {
    const float at = std::clamp(arclength_px / std::max(strip.step_px, 1e-6F), 0.0F,
                                static_cast<float>(points.size() - 1));
    const std::size_t i = std::min(static_cast<std::size_t>(at), points.size() - 2);
    const float t = at - static_cast<float>(i);
    curve.points_cam.push_back((1 - t) * points[i] + t * points[i + 1]);
    curve.arclength_px.push_back(arclength_px);
    curve.sigma_m.push_back((1 - t) * sigma_m[i] + t * sigma_m[i + 1]);
  };
  add(extent.begin_px);
  for (const Station& station : strip.stations) {
    if (station.arclength_px > extent.begin_px && station.arclength_px < extent.end_px) {
      add(station.arclength_px);
    }
  }
  add(extent.end_px);
  return curve;
}

/// The curve's nodes; returns their arclengths on the strip.
std::vector<float> place_nodes(const Curve& curve, Prior& prior) {
  const std::vector<float> length_m = geometry::cumulative_length(curve.points_cam);
  std::vector<float> arclength_px;
  std::size_t segment = 0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const float target = static_cast<float>(i) / (kNodes - 1) * length_m.back();
    while (segment + 2 < length_m.size() && length_m[segment + 1] < target) ++segment;
    const float span = length_m[segment + 1] - length_m[segment];
    const float t = span > 0 ? std::clamp((target - length_m[segment]) / span, 0.0F, 1.0F) : 0;
    prior.nodes[i] =
        geometry::to_point((1 - t) * curve.points_cam[segment] + t * curve.points_cam[segment + 1]);
    prior.sigma_m[i] = (1 - t) * curve.sigma_m[segment] + t * curve.sigma_m[segment + 1];
    arclength_px.push_back((1 - t) * curve.arclength_px[segment] +
                           t * curve.arclength_px[segment + 1]);
  }
  return arclength_px;
}

/// Eq. (3.3) and (3.6) at the nodes' projections. Returns whether any node is supported.
bool support_nodes(const Strip& strip, const std::vector<float>& node_arclength_px,
                   const evidence::VisiblePoints& visible, const Intrinsics& camera,
                   float radius_px, float arc_window_px, Prior& prior) {
  std::vector<Vector2f> path_px;
  std::vector<float> arclength_px;
  for (const Station& station : strip.stations) {
    path_px.push_back(station.point_px);
    arclength_px.push_back(station.arclength_px);
  }
  std::vector<Sighting> sightings;
  for (std::size_t j = 0; j < visible.points_cam.size(); ++j) {
    const Point3& point = visible.points_cam[j];
    if (visible.valid[j] == 0 || !(point.z > 0)) continue;
    sightings.push_back({geometry::project(camera, point), point.z});
  }
  const std::vector<float> found =
      associate(path_px, arclength_px, sightings, radius_px, arc_window_px);
  bool any = false;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const Vector2f node_px = geometry::project(camera, prior.nodes[i]);
    for (std::size_t j = 0; j < found.size() && prior.support[i] == 0; ++j) {
      if (found[j] < 0 || std::abs(found[j] - node_arclength_px[i]) > arc_window_px) continue;
      if ((sightings[j].position_px - node_px).norm() > radius_px) continue;  // Eq. (3.3)
      prior.support[i] = 1;                                                   // Eq. (3.6)
      any = true;
    }
  }
  return any;
}

bool usable(const path::Path& path) {
  return path.points_px.size() >= 2 &&
         std::all_of(path.points_px.begin(), path.points_px.end(),
                     [](const Vector2f& point) { return point.allFinite(); });
}

/// The path's points, those outside of the image moved to its border.
std::vector<Vector2f> inside(const path::Path& path, const Frame& frame) {
  const Vector2f last{static_cast<float>(frame.width - 1), static_cast<float>(frame.height - 1)};
  std::vector<Vector2f> points;
  for (const Vector2f& point : path.points_px) {
    points.emplace_back(point.cwiseMax(Vector2f::Zero()).cwiseMin(last));
  }
  return points;
}

Error no_evidence(const char* expected, int got) {
  return Error{
      ErrorCode::kNoEvidence,
      fmt::format("prior::refine: expected {}, got none of {}; check that depth is in metres, "
                  "and that depth and mask belong to the same camera",
                  expected, got)};
}

}  // namespace

Result<Prior> refine(const path::Path& path, float rope_width_px, const evidence::Cloud& cloud,
                     const evidence::VisiblePoints& visible, const Frame& frame,
                     const RefineConfig& config) {
  if (!usable(path)) {
    return Error{ErrorCode::kNoPath,
                 fmt::format("prior::refine: expected a path of at least 2 finite points, got {}; "
                             "check the mask",
                             path.points_px.size())};
  }
  const std::size_t pixels = static_cast<std::size_t>(frame.width) * frame.height;
  if (frame.mask.size() != pixels || frame.depth_m.size() != pixels) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("prior::refine: expected {} depths and mask pixels, got {} and {}; "
                             "validate the frame first",
                             pixels, frame.depth_m.size(), frame.mask.size())};
  }
  if (cloud.points_cam.empty()) return no_evidence("mask pixels with a depth", 0);
  const float width_px =
      std::isfinite(rope_width_px) ? std::clamp(rope_width_px, 1.0F, kMostWidthPx) : 1.0F;
  const std::vector<Vector2f> points_px = to_the_tips(inside(path, frame), width_px, frame);
  Strip strip = make_strip(points_px, width_px, frame, cloud);
  drop_sunken(strip);
  const Extent extent = without_caps(strip, frame);
  const RopeDepth rope = measure_rope(strip, extent);
  if (rope.axis_m.empty()) {
    return no_evidence("depths beside the path", static_cast<int>(cloud.points_cam.size()));
  }
  Prior prior;
  const Curve curve = make_curve(strip, rope, extent, frame.intrinsics.fx);
  const std::vector<float> arclength_px = place_nodes(curve, prior);
  doubt_along({strip, extent, rope, frame}, arclength_px, prior);
  const float scale = geometry::pixel_scale(frame.width);
  const float radius_px = std::max(config.lift.lift_radius_px * scale, 0.5F * width_px);
  if (!support_nodes(strip, arclength_px, visible, frame.intrinsics, radius_px,
                     config.lift.arc_window_px * scale, prior)) {
    return no_evidence("visible points beside the path", visible.count);
  }
  if (!is_canonical(prior.nodes)) {  // Sec. 3.3
    std::reverse(prior.nodes.begin(), prior.nodes.end());
    std::reverse(prior.support.begin(), prior.support.end());
    std::reverse(prior.sigma_m.begin(), prior.sigma_m.end());
  }
  return prior;
}

}  // namespace flowdlo::prior
