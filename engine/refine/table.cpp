#include "refine/table.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "evidence/beside_rope.hpp"
#include "evidence/inverse_plane.hpp"
#include "geometry/camera.hpp"
#include "geometry/quantile.hpp"

namespace flowdlo::refine {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kLeastKnown = 0.25F;
constexpr float kApartPx = 16;  // of an image 640 px wide: a window
constexpr double kDeviation = 1.4826;
constexpr float kLeastSine = 0.2F;

/// Depths beside the rope.
struct Depths {
  std::vector<evidence::InverseDepth> seen;
  std::vector<std::size_t> place;  // [seen.size()] beside which each lies,
  std::vector<int> side;           // and on which side of it
};

Depths depths_beside(std::span<const AxisPlace> places, const Frame& frame,
                     std::span<Beside> beside) {
  evidence::BesideRope at = evidence::BesideRope::of_width(frame.width);
  const float scale = geometry::pixel_scale(frame.width);
  at.clear_px = static_cast<int>(std::lround(static_cast<float>(at.clear_px) * scale));
  const Intrinsics& camera = frame.intrinsics;
  Depths depths;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vector2f across(-places[i].along.y(), places[i].along.x());
    for (const int side : {-1, 1}) {
      const Vector2f outward = static_cast<float>(side) * across;
      const Vector2f edge_px = places[i].px + places[i].half_px * outward;
      const float depth_m = evidence::depth_beside(edge_px, outward, at, frame);
      if (depth_m <= 0) continue;
      const Vector2f p = edge_px + at.middle_px() * outward;
      const Vector3f ray = geometry::to_eigen(geometry::unproject(camera, p.x(), p.y(), 1));
      depths.seen.push_back({ray.cast<double>(), 1 / static_cast<double>(depth_m)});
      depths.place.push_back(i);
      depths.side.push_back(side);
      Beside& here = beside[i];
      here.depth_m = (here.depth_m * static_cast<float>(here.sides) + depth_m) /
                     static_cast<float>(here.sides + 1);
      ++here.sides;
    }
  }
  return depths;
}

/// What misfits differ by that lie a window apart, on the same side.
double roughness(const evidence::InversePlane& plane, const Depths& depths,
                 std::span<const AxisPlace> places, float apart_px) {
  std::vector<double> differences;
  for (const int side : {-1, 1}) {
    std::size_t from = 0;
    for (std::size_t k = 0; k < depths.seen.size(); ++k) {
      if (depths.side[k] != side) continue;
      const auto away_px = [&](std::size_t other) {
        return (places[depths.place[other]].px - places[depths.place[k]].px).norm();
      };
      while (from < k && (depths.side[from] != side || away_px(from) > 2 * apart_px)) ++from;
      if (from == k || away_px(from) < apart_px) continue;
      differences.push_back(std::abs(plane.off(depths.seen[k]) - plane.off(depths.seen[from])));
    }
  }
  return differences.empty() ? 0 : geometry::median_of(differences) / std::sqrt(2.0);
}

}  // namespace

std::optional<Table> table_beside(std::span<const AxisPlace> places, const Frame& frame,
                                  std::span<Beside> beside) {
  const Depths depths = depths_beside(places, frame, beside);
  const auto known = static_cast<float>(
      std::count_if(beside.begin(), beside.end(), [](const Beside& at) { return at.sides > 0; }));
  const float share = known / static_cast<float>(std::max<std::size_t>(1, places.size()));
  if (share < kLeastKnown) return std::nullopt;
  const auto plane = evidence::inverse_plane(depths.seen);
  if (!plane) return std::nullopt;
  const float apart_px = kApartPx * geometry::pixel_scale(frame.width);
  Table table;
  table.plane = plane->normal.cast<float>();
  table.misfit = static_cast<float>(plane->misfit);
  table.roughness = static_cast<float>(kDeviation * roughness(*plane, depths, places, apart_px));
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
