// A rope drawn from its true centerline, with the path that a perfect tracer would give.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "evidence/visible_points.hpp"
#include "geometry/camera.hpp"
#include "path/path.hpp"
#include "prior/refined_prior.hpp"
#include "scene/curve.hpp"
#include "scene/render.hpp"

namespace flowdlo::prior::testing {

inline constexpr double kRadius_m = 0.006;

struct DrawnRope {
  lab::Image image;
  lab::Curve3 curve;
  path::Path path;
  float width_px = 0;

  [[nodiscard]] Frame frame() const {
    return {image.width, image.height, image.camera, image.depth_m, image.mask, {}};
  }
  [[nodiscard]] Eigen::Vector2f pixel(const Eigen::Vector3d& p) const {
    return geometry::project(image.camera, geometry::to_point(p.cast<float>()));
  }
  /// Where the pixel is in the images.
  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(image.width) +
           static_cast<std::size_t>(u);
  }
  [[nodiscard]] Result<Prior> refined() const {
    const auto cloud = evidence::unproject(frame());
    return refine(path, width_px, cloud, evidence::visible_points(cloud), frame());
  }
};

/// `curve` as a tube with round caps, far before a wall; its path reaches the mask's tips.
inline DrawnRope draw_rope(const lab::Curve3& curve, const std::vector<lab::Bar>& bars = {}) {
  DrawnRope rope;
  rope.image.width = 640;
  rope.image.height = 480;
  rope.image.camera = {600, 600, 320, 240};
  rope.curve = lab::respaced(curve, 0.25 * kRadius_m);
  lab::render(rope.curve, kRadius_m, {.normal = {0, 0, 1}, .offset_m = 2}, bars, rope.image);
  lab::Curve3 tips = rope.curve;
  const Eigen::Vector3d front = (tips[0] - tips[1]).normalized() * kRadius_m;
  const Eigen::Vector3d back = (tips.back() - tips[tips.size() - 2]).normalized() * kRadius_m;
  tips.insert(tips.begin(), tips.front() + front);
  tips.push_back(tips.back() + back);
  for (const Eigen::Vector3d& p : tips) rope.path.points_px.push_back(rope.pixel(p));
  rope.path.bridged.assign(rope.path.points_px.size(), 0);
  const double middle_m = curve[curve.size() / 2].z();
  rope.width_px = static_cast<float>(2 * kRadius_m * 600 / middle_m);
  return rope;
}

/// 12 px wide, ends at u = 120 and 520; a little aslant, so that its width is not one of whole
/// pixels all along.
inline lab::Curve3 straight_line() { return {{-0.2, -0.004, 0.6}, {0.2, 0.004, 0.6}}; }

/// `straight_line` without round caps: in the mask from u = 150 to 490.
inline DrawnRope cut_off_square() {
  DrawnRope rope = draw_rope(straight_line());
  for (int v = 0; v < rope.image.height; ++v) {
    for (int u = 0; u < rope.image.width; ++u) {
      if (u < 150 || u > 490) rope.image.mask[rope.index(u, v)] = 0;
    }
  }
  rope.path.points_px = {{150, 236.6F}, {490, 243.4F}};
  return rope;
}

/// No depth where first_u <= u < last_u.
inline void erase_depth(DrawnRope& rope, int first_u, int last_u) {
  for (int v = 0; v < rope.image.height; ++v) {
    for (int u = first_u; u < last_u; ++u) rope.image.depth_m[rope.index(u, v)] = 0;
  }
}

/// Along u at z = 0.6, round a loop and back along v, crossing at (320, 240) at z = `second_m`.
inline lab::Curve3 crossing_line(double second_m) {
  lab::Curve3 curve;
  for (double x = -0.2; x < 0.1; x += 0.002) curve.emplace_back(x, 0, 0.6);
  const double r = 0.1;  // three quarters of a circle about (0.1, -0.1)
  for (double a = 0; a <= 1; a += 0.01) {
    const double angle = 0.5 * std::numbers::pi - 1.5 * std::numbers::pi * a;
    curve.emplace_back(0.1 + r * std::cos(angle), -0.1 + r * std::sin(angle),
                       0.6 + (second_m - 0.6) * a);
  }
  for (double y = -0.1; y < 0.15; y += 0.002) curve.emplace_back(0, y, second_m);
  return curve;
}

/// Metres from `point` to the curve.
inline double distance_to(const lab::Curve3& curve, const Point3& point) {
  const Eigen::Vector3d p = geometry::to_eigen(point).cast<double>();
  double least = 1e9;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    const Eigen::Vector3d d = curve[i] - curve[i - 1];
    const double t = std::clamp((p - curve[i - 1]).dot(d) / d.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (p - curve[i - 1] - t * d).norm());
  }
  return least;
}

/// The rope's refined prior; a failure of the test where there is none.
inline Prior refined(const DrawnRope& rope) {
  const Result<Prior> prior = rope.refined();
  EXPECT_TRUE(prior.has_value()) << prior.error().message;
  return prior ? *prior : Prior{};
}

/// Metres from the curve, of all nodes but the outermost ones: how far the ends reach has tests of
/// its own.
inline double farthest(const Prior& prior, const lab::Curve3& curve) {
  double most = 0;
  for (std::size_t i = 1; i + 1 < prior.nodes.size(); ++i) {
    most = std::max(most, distance_to(curve, prior.nodes[i]));
  }
  return most;
}

}  // namespace flowdlo::prior::testing
