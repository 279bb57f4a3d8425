// Sec. 3.2: visible 3D evidence from mask, depth and intrinsics.
#include "evidence/visible_points.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/camera.hpp"
#include "geometry/mask_box.hpp"
#include "reference/farthest_points.hpp"

namespace flowdlo::evidence {
namespace {

constexpr float kMinDepth_m = 1e-6F;          // Sec. 3.2
constexpr std::uint8_t kMaskThreshold = 127;  // 0.5 of an 8-bit mask

/// Points of a cloud at most: a frame of 1920 x 1080 pixels all of which are mask. Beyond it there
/// are more than enough, and sampling them would take time and memory without bound.
constexpr std::size_t kMostPoints = std::size_t{1} << 21;

bool is_finite(const Point3& point) {
  return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
}

/// How many pixels the mask has for each that becomes a point; 1: all of them do.
std::size_t pixels_a_point(const Frame& frame) {
  if (frame.mask.size() <= kMostPoints) return 1;
  const auto masked = static_cast<std::size_t>(
      std::count_if(frame.mask.begin(), frame.mask.end(),
                    [](std::uint8_t value) { return value > kMaskThreshold; }));
  return std::max<std::size_t>(1, (masked + kMostPoints - 1) / kMostPoints);
}

}  // namespace

Cloud unproject(const Frame& frame) {
  Cloud cloud;
  const std::size_t each = pixels_a_point(frame);
  std::size_t passed = 0;  // of the mask's pixels
  geometry::each_masked(frame, [&](int u, int v, std::size_t pixel) {
    if (each > 1 && passed++ % each != 0) return;
    const float depth_m = frame.depth_m[pixel];
    if (!std::isfinite(depth_m) || depth_m <= kMinDepth_m) return;
    const Point3 point = geometry::unproject(frame.intrinsics, static_cast<float>(u),
                                             static_cast<float>(v), depth_m);  // Eq. (2.2)
    if (!is_finite(point)) return;  // a depth near the end of the float range
    cloud.points_cam.push_back(point);
    cloud.pixels.push_back(static_cast<int>(pixel));
  });
  return cloud;
}

Point3 centroid(const Cloud& cloud) {
  if (cloud.points_cam.empty()) return {};
  double x = 0;
  double y = 0;
  double z = 0;
  for (const Point3& point : cloud.points_cam) {
    x += static_cast<double>(point.x);
    y += static_cast<double>(point.y);
    z += static_cast<double>(point.z);
  }
  const auto count = static_cast<double>(cloud.points_cam.size());
  return {static_cast<float>(x / count), static_cast<float>(y / count),
          static_cast<float>(z / count)};
}

VisiblePoints visible_points(const Cloud& cloud) {
  const auto count = static_cast<int>(cloud.points_cam.size());
  std::vector<float> cloud_xyzw;
  cloud_xyzw.reserve(4 * cloud.points_cam.size());
  for (const Point3& point : cloud.points_cam) {
    cloud_xyzw.insert(cloud_xyzw.end(), {point.x, point.y, point.z, 0.0F});
  }
  const Point3 mean = centroid(cloud);
  const float mean_xyz[3] = {mean.x, mean.y, mean.z};
  std::array<float, 4 * kVisiblePoints> rows{};
  reference::farthest_points(cloud_xyzw, count, mean_xyz, rows);

  VisiblePoints visible;
  visible.count = std::min(count, kVisiblePoints);
  for (std::size_t i = 0; i < kVisiblePoints; ++i) {
    visible.points_cam[i] = {rows[4 * i], rows[4 * i + 1], rows[4 * i + 2]};
    visible.valid[i] = rows[4 * i + 3] > 0.5F ? 1 : 0;
  }
  return visible;
}

}  // namespace flowdlo::evidence
