#include "refine/table.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "evidence/beside_rope.hpp"
#include "geometry/camera.hpp"
#include "geometry/quantile.hpp"

namespace flowdlo::refine {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr std::size_t kLeastPoints = 48;
constexpr float kLeastKnown = 0.25F;
constexpr float kApartPx = 16;  // of an image 640 px wide: a window
// The first plane is the one of least median misfit through three points, of so many triples and
// over so many points.
constexpr int kTriples = 80;
constexpr std::size_t kJudges = 192;
constexpr double kFlattest = 1e-7;  // determinant of three rays
constexpr int kRounds = 5;          // of Tukey's biweight
constexpr double kTukey = 3.5;      // misfits
constexpr double kDeviation = 1.4826;
constexpr double kLeastMisfit = 1e-4;  // 1 / m
constexpr float kLeastSine = 0.2F;

/// A point beside the rope.
struct Point {
  Vector3d ray{0, 0, 1};
  double inverse = 0;  // 1 / z
  std::size_t place = 0;
  int side = 0;
};

std::vector<Point> points_beside(std::span<const AxisPlace> places, const Frame& frame,
                                 std::span<Beside> beside) {
  evidence::BesideRope at = evidence::BesideRope::of_width(frame.width);
  const float scale = geometry::pixel_scale(frame.width);
  at.clear_px = static_cast<int>(std::lround(static_cast<float>(at.clear_px) * scale));
  const Intrinsics& camera = frame.intrinsics;
  constexpr evidence::BesideRope kAt640;
  const float out_px = 0.5F * static_cast<float>(kAt640.from_px + kAt640.to_px) * scale;
  std::vector<Point> points;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vector2f across(-places[i].along.y(), places[i].along.x());
    for (const int side : {-1, 1}) {
      const Vector2f outward = static_cast<float>(side) * across;
      const Vector2f edge_px = places[i].px + places[i].half_px * outward;
      const float depth_m = evidence::depth_beside(edge_px, outward, at, frame);
      if (depth_m <= 0) continue;
      const Vector2f p = edge_px + out_px * outward;
      const Vector3f ray((p.x() - camera.cx) / camera.fx, (p.y() - camera.cy) / camera.fy, 1);
      points.push_back({ray.cast<double>(), 1 / static_cast<double>(depth_m), i, side});
      Beside& here = beside[i];
      here.depth_m = (here.depth_m * static_cast<float>(here.sides) + depth_m) /
                     static_cast<float>(here.sides + 1);
      ++here.sides;
    }
  }
  return points;
}

double misfit(const Vector3d& plane, const Point& point) {
  return plane.dot(point.ray) - point.inverse;
}

/// Of all of `points`, every `stride`-th.
double median_misfit(const Vector3d& plane, const std::vector<Point>& points, std::size_t stride) {
  std::vector<double> misfits;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    misfits.push_back(std::abs(misfit(plane, points[i])));
  }
  return geometry::median_of(misfits);
}

/// Nothing where all points lie on a line of the image.
std::optional<Vector3d> first_plane(const std::vector<Point>& points) {
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kJudges);
  std::optional<Vector3d> best;
  double least = 0;
  std::uint32_t state = 1;  // the same triples in every call
  const auto any = [&] {
    state = state * 1664525U + 1013904223U;
    return (state >> 8U) % points.size();
  };
  for (int triple = 0; triple < kTriples; ++triple) {
    Eigen::Matrix3d rays;
    Vector3d inverse;
    for (int k = 0; k < 3; ++k) {
      const Point& point = points[any()];
      rays.row(k) = point.ray;
      inverse(k) = point.inverse;
    }
    if (std::abs(rays.determinant()) < kFlattest) continue;
    const Vector3d plane = rays.inverse() * inverse;
    const double here = median_misfit(plane, points, stride);
    if (best && here >= least) continue;
    best = plane;
    least = here;
  }
  return best;
}

/// Tukey's biweight, from a plane that is about right.
Vector3d fitted(Vector3d plane, const std::vector<Point>& points) {
  for (int round = 0; round < kRounds; ++round) {
    const double most =
        kTukey * std::max(kLeastMisfit, kDeviation * median_misfit(plane, points, 1));
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
    Vector3d right = Vector3d::Zero();
    for (const Point& point : points) {
      const double off = misfit(plane, point) / most;
      if (std::abs(off) >= 1) continue;
      const double weight = (1 - off * off) * (1 - off * off);
      products += weight * point.ray * point.ray.transpose();
      right += weight * point.inverse * point.ray;
    }
    products += 1e-9 * products.trace() * Eigen::Matrix3d::Identity();
    plane = products.ldlt().solve(right);
  }
  return plane;
}

/// What misfits differ by that lie a window apart, on the same side.
double roughness(const Vector3d& plane, const std::vector<Point>& points,
                 std::span<const AxisPlace> places, float apart_px) {
  std::vector<double> differences;
  for (const int side : {-1, 1}) {
    std::size_t from = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (points[k].side != side) continue;
      const Vector2f& here = places[points[k].place].px;
      while (from < k && (points[from].side != side ||
                          (places[points[from].place].px - here).norm() > 2 * apart_px)) {
        ++from;
      }
      if (from == k || (places[points[from].place].px - here).norm() < apart_px) continue;
      differences.push_back(std::abs(misfit(plane, points[k]) - misfit(plane, points[from])));
    }
  }
  return differences.empty() ? 0 : geometry::median_of(differences) / std::sqrt(2.0);
}

}  // namespace

std::optional<Table> table_beside(std::span<const AxisPlace> places, const Frame& frame,
                                  std::span<Beside> beside) {
  const std::vector<Point> points = points_beside(places, frame, beside);
  const auto known = static_cast<float>(
      std::count_if(beside.begin(), beside.end(), [](const Beside& at) { return at.sides > 0; }));
  const float share = known / static_cast<float>(std::max<std::size_t>(1, places.size()));
  if (points.size() < kLeastPoints || share < kLeastKnown) return std::nullopt;
  const auto first = first_plane(points);
  if (!first) return std::nullopt;
  const Vector3d plane = fitted(*first, points);
  if (!plane.allFinite() || !(plane.norm() > 0)) return std::nullopt;
  const float apart_px = kApartPx * geometry::pixel_scale(frame.width);
  Table table;
  table.plane = plane.cast<float>();
  table.misfit =
      static_cast<float>(std::max(kLeastMisfit, kDeviation * median_misfit(plane, points, 1)));
  table.roughness = static_cast<float>(kDeviation * roughness(plane, points, places, apart_px));
  table.known = share;
  return table;
}

std::optional<float> share_to(const Table& table, const Vector3f& point_cam, float radius_m) {
  const float size = table.plane.norm();
  const float toward = table.plane.dot(point_cam);
  const float on_it = 1 - radius_m * size;
  if (!(toward > kLeastSine * size * point_cam.norm()) || !(on_it > 0)) return std::nullopt;
  return on_it / toward;
}

}  // namespace flowdlo::refine
