#include "estimator/rope_crossings.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>

#include "geometry/segments.hpp"

namespace flowdlo::estimator {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::size_t kApart = 3;  // segments of one rope that may cross each other
constexpr double kBackWidths = 2;  // lines that cross back within this do not cross

// One rope's nodes in space and in the image; of a ring the first once more at the end.
struct Line {
  std::vector<Vector3d> nodes;
  std::vector<Vector2d> pixels;
  std::vector<double> along_m;
  bool drawable = true;

  Line(const Estimate& rope, const Intrinsics& camera) {
    for (const Point3& p : rope.nodes) add({p.x, p.y, p.z}, camera);
    if (rope.closed && !nodes.empty()) add(Vector3d(nodes.front()), camera);
  }

  void add(const Vector3d& p, const Intrinsics& camera) {
    drawable = drawable && p.allFinite() && p.z() > 0;
    along_m.push_back(nodes.empty() ? 0 : along_m.back() + (p - nodes.back()).norm());
    nodes.push_back(p);
    pixels.emplace_back(camera.fx * p.x() / p.z() + camera.cx,
                        camera.fy * p.y() / p.z() + camera.cy);
  }
};

// Two lines in the image: places on both in segments, and depths there.
struct Met {
  std::array<double, 2> place{};
  std::array<double, 2> along_m{};
  std::array<double, 2> depth_m{};
  Vector2d at{0, 0};
};

std::vector<Met> met(const Line& a, const Line& b, bool same, bool closed) {
  std::vector<Met> result;
  const std::size_t count = a.nodes.size() - 1;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector2d d = a.pixels[i + 1] - a.pixels[i];
    for (std::size_t j = same ? i + kApart : 0; j + 1 < b.nodes.size(); ++j) {
      if (same && closed && i + count - j < kApart) continue;
      const Vector2d e = b.pixels[j + 1] - b.pixels[j];
      const auto meeting = geometry::meeting(a.pixels[i], d, b.pixels[j], e);
      if (!meeting) continue;
      const double t = (*meeting)[0];
      const double s = (*meeting)[1];
      const auto mixed = [](const auto& list, std::size_t k, double share) {
        return (1 - share) * list[k] + share * list[k + 1];
      };
      result.push_back({{static_cast<double>(i) + t, static_cast<double>(j) + s},
                        {mixed(a.along_m, i, t), mixed(b.along_m, j, s)},
                        {(1 - t) * a.nodes[i].z() + t * a.nodes[i + 1].z(),
                         (1 - s) * b.nodes[j].z() + s * b.nodes[j + 1].z()},
                        a.pixels[i] + t * d});
    }
  }
  return result;
}

// Without the pairs that are a step to the other side and back.
std::vector<Met> lasting(std::vector<Met> all, double width_px) {
  for (std::size_t i = 0; i + 1 < all.size();) {
    if ((all[i].at - all[i + 1].at).norm() < kBackWidths * width_px) {
      all.erase(all.begin() + static_cast<std::ptrdiff_t>(i),
                all.begin() + static_cast<std::ptrdiff_t>(i) + 2);
    } else {
      ++i;
    }
  }
  return all;
}

// The mask's area over the lines' length.
double mean_width(const std::vector<Line>& lines, const Frame& frame) {
  double length_px = 0;
  for (const Line& line : lines) {
    for (std::size_t i = 1; line.drawable && i < line.pixels.size(); ++i) {
      length_px += (line.pixels[i] - line.pixels[i - 1]).norm();
    }
  }
  const auto area = std::count_if(frame.mask.begin(), frame.mask.end(),
                                  [](std::uint8_t value) { return value > 127; });
  return static_cast<double>(area) / std::max(1.0, length_px);
}

}  // namespace

std::vector<RopeCrossing> rope_crossings(const std::vector<Estimate>& ropes, const Frame& frame) {
  std::vector<Line> lines;
  for (const Estimate& rope : ropes) lines.emplace_back(rope, frame.intrinsics);
  const double width_px = mean_width(lines, frame);
  std::vector<RopeCrossing> crossings;
  for (std::size_t a = 0; a < lines.size(); ++a) {
    for (std::size_t b = a; b < lines.size(); ++b) {
      if (!lines[a].drawable || !lines[b].drawable) continue;
      const auto all = met(lines[a], lines[b], a == b, ropes[a].closed);
      for (const Met& m : lasting(all, width_px)) {
        const std::size_t over = m.depth_m[0] <= m.depth_m[1] ? 0 : 1;
        const std::array<int, 2> rope{static_cast<int>(a), static_cast<int>(b)};
        crossings.push_back({rope[over], rope[1 - over], static_cast<float>(m.along_m[over]),
                             static_cast<float>(m.along_m[1 - over]),
                             static_cast<float>(std::abs(m.depth_m[0] - m.depth_m[1]))});
      }
    }
  }
  std::stable_sort(crossings.begin(), crossings.end(),
                   [](const RopeCrossing& a, const RopeCrossing& b) {
                     return std::pair(a.over, a.over_at_m) < std::pair(b.over, b.over_at_m);
                   });
  return crossings;
}

}  // namespace flowdlo::estimator
