#include "gate/tube_shape.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/camera.hpp"
#include "geometry/segments.hpp"

namespace flowdlo::gate {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kStraight = 0.04F;  // bulge a half segment that is not worth a sample

/// Where segment a crosses segment b: fractions of both, each in [0, 1). False when they do not.
bool meet(const Vector2f& from, const Vector2f& a, const Vector2f& other, const Vector2f& b,
          float& at_a, float& at_b) {
  const float det = geometry::cross(a, b);
  if (std::abs(det) < 1e-9F) return false;
  at_a = geometry::cross<float>(other - from, b) / det;
  at_b = geometry::cross<float>(other - from, a) / det;
  return at_a >= 0 && at_a < 1 && at_b >= 0 && at_b < 1;
}

bool apart(const TubePoint& a0, const TubePoint& a1, const TubePoint& b0, const TubePoint& b1) {
  return a0.cell.cwiseMin(a1.cell).x() > b0.cell.cwiseMax(b1.cell).x() ||
         a0.cell.cwiseMin(a1.cell).y() > b0.cell.cwiseMax(b1.cell).y() ||
         a0.cell.cwiseMax(a1.cell).x() < b0.cell.cwiseMin(b1.cell).x() ||
         a0.cell.cwiseMax(a1.cell).y() < b0.cell.cwiseMin(b1.cell).y();
}

}  // namespace

std::vector<TubePoint> smooth_tube(const Centerline& nodes) {
  std::vector<TubePoint> tube;
  const auto add = [&](const Vector3f& point) {
    const float step = tube.empty() ? 0.0F : (point - tube.back().cam).norm();
    const float before = tube.empty() ? 0.0F : tube.back().arclength_m;
    tube.push_back({point, {0, 0}, point.z(), 0, before + step});
  };
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const Vector3f here = geometry::to_eigen(nodes[i]);
    const Vector3f next = geometry::to_eigen(nodes[i + 1]);
    add(here);
    if (i == 0 || i + 2 >= nodes.size()) continue;
    const Vector3f before = geometry::to_eigen(nodes[i - 1]);
    const Vector3f after = geometry::to_eigen(nodes[i + 2]);
    const Vector3f middle = (9 * (here + next) - before - after) / 16;  // Catmull-Rom at one half
    // Only where it bends, and between neighbours of like length: a jump would swing out.
    const float most = 0.5F * (next - here).norm();
    const Vector3f straight = 0.5F * (here + next);
    const float bulge = (middle - straight).norm();
    if (bulge > kStraight * most && bulge <= most && middle.z() > 0) add(middle);
  }
  add(geometry::to_eigen(nodes.back()));
  return tube;
}

double cells_outside(const std::vector<TubePoint>& tube, int width, int height) {
  double cells = 0;
  for (std::size_t i = 0; i + 1 < tube.size(); ++i) {
    const Vector2f middle = 0.5F * (tube[i].cell + tube[i + 1].cell);
    if (middle.x() >= 0 && middle.y() >= 0 && middle.x() < static_cast<float>(width) &&
        middle.y() < static_cast<float>(height)) {
      continue;
    }
    const float area = (tube[i + 1].cell - tube[i].cell).norm() * 2 * tube[i].radius_cells;
    cells += static_cast<double>(area);
  }
  return cells;
}

void measure_crossings(const std::vector<TubePoint>& tube, float radius_m, TubeScore& score) {
  int crossings = 0;
  float least_sine = 1;
  float least_clearance = 1;
  for (std::size_t i = 0; i + 1 < tube.size(); ++i) {
    const Vector2f a = tube[i + 1].cell - tube[i].cell;
    for (std::size_t k = i + 2; k + 1 < tube.size(); ++k) {
      if (apart(tube[i], tube[i + 1], tube[k], tube[k + 1])) continue;
      const Vector2f b = tube[k + 1].cell - tube[k].cell;
      float at_a = 0;
      float at_b = 0;
      if (!meet(tube[i].cell, a, tube[k].cell, b, at_a, at_b)) continue;
      const float depth_a = tube[i].depth_m + at_a * (tube[i + 1].depth_m - tube[i].depth_m);
      const float depth_b = tube[k].depth_m + at_b * (tube[k + 1].depth_m - tube[k].depth_m);
      ++crossings;
      least_sine = std::min(least_sine, std::abs(geometry::cross(a, b)) / (a.norm() * b.norm()));
      least_clearance = std::min(least_clearance, std::abs(depth_a - depth_b) / (2 * radius_m));
    }
  }
  score.crossings = static_cast<float>(std::min(crossings, 99));
  score.least_sine = least_sine;
  score.least_clearance = least_clearance;
}

void measure_bends(const Centerline& nodes, float radius_m, TubeScore& score) {
  float bending = 0;
  float sharpest = 0;
  for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
    const Vector3f before = geometry::to_eigen(nodes[i]) - geometry::to_eigen(nodes[i - 1]);
    const Vector3f after = geometry::to_eigen(nodes[i + 1]) - geometry::to_eigen(nodes[i]);
    const float spacing_m = 0.5F * (before.norm() + after.norm());
    if (!(spacing_m > 1e-9F)) continue;
    const float angle = std::atan2(before.cross(after).norm(), before.dot(after));
    const float curvature = angle / spacing_m;
    bending += radius_m * curvature * curvature * spacing_m;
    sharpest = std::max(sharpest, radius_m * curvature);
  }
  score.bending = std::isfinite(bending) ? std::min(bending, 99.0F) : 99.0F;
  score.sharpest_bend = std::isfinite(sharpest) ? std::min(sharpest, 2.0F) : 2.0F;
}

}  // namespace flowdlo::gate
