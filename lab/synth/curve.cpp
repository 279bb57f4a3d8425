#include "synth/curve.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

namespace flowdlo::synth {
namespace {

constexpr double kContact = 2.4;      // radii between centerlines that count as touching
constexpr double kOtherStrand = 8.0;  // radii of arclength between strands
constexpr std::size_t kChunk = 16;    // samples a bounding box

// Bounding boxes of runs of samples; pairs of runs that are far apart need no closer look.
template <class Vector>
struct Chunks {
  std::vector<Vector> low;
  std::vector<Vector> high;

  explicit Chunks(std::span<const Vector> points) {
    for (std::size_t at = 0; at + 1 < points.size(); at += kChunk) {
      const std::size_t end = std::min(points.size(), at + kChunk + 1);
      Vector least = points[at];
      Vector most = points[at];
      for (std::size_t i = at; i < end; ++i) {
        least = least.cwiseMin(points[i]);
        most = most.cwiseMax(points[i]);
      }
      low.push_back(least);
      high.push_back(most);
    }
  }
  [[nodiscard]] bool near(std::size_t a, const Chunks& other, std::size_t b, double reach) const {
    return ((low[a] - other.high[b]).array() <= reach).all() &&
           ((other.low[b] - high[a]).array() <= reach).all();
  }
  [[nodiscard]] bool near(std::size_t a, std::size_t b, double reach) const {
    return near(a, *this, b, reach);
  }
};

double side(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Run `a` of one line against run `b` of another, or of the same one.
void cross_chunks(std::span<const Vector2d> one, std::size_t a, std::span<const Vector2d> other,
                  std::size_t b, std::vector<Crossing>& found) {
  const bool same = one.data() == other.data();
  const std::size_t end_a = std::min(one.size() - 1, (a + 1) * kChunk);
  const std::size_t end_b = std::min(other.size() - 1, (b + 1) * kChunk);
  for (std::size_t i = a * kChunk; i < end_a; ++i) {
    const Vector2d d = one[i + 1] - one[i];
    for (std::size_t j = std::max(same ? i + 2 : 0, b * kChunk); j < end_b; ++j) {
      const Vector2d e = other[j + 1] - other[j];
      const double cross = side(d, e);
      if (std::abs(cross) < 1e-18) continue;
      const Vector2d between = other[j] - one[i];
      const double t = side(between, e) / cross;
      const double s = side(between, d) / cross;
      if (t < 0 || t >= 1 || s < 0 || s >= 1) continue;
      found.push_back({static_cast<double>(i) + t, static_cast<double>(j) + s,
                       std::abs(cross) / (d.norm() * e.norm())});
    }
  }
}

}  // namespace

Curve respaced(std::span<const Vector3d> points, double spacing_m) {
  std::vector<double> at(points.size(), 0);
  for (std::size_t i = 1; i < points.size(); ++i) {
    at[i] = at[i - 1] + (points[i] - points[i - 1]).norm();
  }
  const double length = at.back();
  const auto steps = 4 * static_cast<std::size_t>(std::max(2.0, std::ceil(length / spacing_m / 4)));
  Curve curve;
  curve.step_m = length / static_cast<double>(steps);
  curve.points.reserve(steps + 1);
  std::size_t from = 0;
  for (std::size_t k = 0; k < steps; ++k) {
    const double wanted = static_cast<double>(k) * curve.step_m;
    while (from + 2 < points.size() && at[from + 1] <= wanted) ++from;
    const double t = (wanted - at[from]) / std::max(1e-12, at[from + 1] - at[from]);
    curve.points.emplace_back(points[from] + t * (points[from + 1] - points[from]));
  }
  curve.points.push_back(points.back());
  return curve;
}

void smooth(std::vector<Vector3d>& points, int reach) {
  const auto count = static_cast<int>(points.size());
  std::vector<Vector3d> sums(points.size() + 1, Vector3d::Zero());
  for (int i = 0; i < count; ++i) sums[i + 1] = sums[i] + points[i];
  for (int i = 1; i + 1 < count; ++i) {
    const int r = std::min({reach, i, count - 1 - i});
    points[i] = (sums[i + r + 1] - sums[i - r]) / (2 * r + 1);
  }
}

std::vector<Crossing> crossings(std::span<const Vector2d> points) {
  std::vector<Crossing> found;
  const Chunks<Vector2d> chunks(points);
  for (std::size_t a = 0; a < chunks.low.size(); ++a) {
    for (std::size_t b = a; b < chunks.low.size(); ++b) {
      if (chunks.near(a, b, 0)) cross_chunks(points, a, points, b, found);
    }
  }
  return found;
}

std::vector<Crossing> crossings(std::span<const Vector2d> a, std::span<const Vector2d> b) {
  std::vector<Crossing> found;
  const Chunks<Vector2d> of_a(a);
  const Chunks<Vector2d> of_b(b);
  for (std::size_t i = 0; i < of_a.low.size(); ++i) {
    for (std::size_t j = 0; j < of_b.low.size(); ++j) {
      if (of_a.near(i, of_b, j, 0)) cross_chunks(a, i, b, j, found);
    }
  }
  return found;
}

double least_bend_radius_m(const Curve& curve, double radius_m) {
  const auto apart =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(2 * radius_m / curve.step_m)));
  double least = std::numeric_limits<double>::max();
  for (std::size_t i = apart; i + apart < curve.points.size(); ++i) {
    const Vector3d a = curve.points[i] - curve.points[i - apart];
    const Vector3d b = curve.points[i + apart] - curve.points[i];
    const double doubled_area = a.cross(b).norm();
    if (doubled_area < 1e-15) continue;
    least = std::min(least, a.norm() * b.norm() * (a + b).norm() / (2 * doubled_area));
  }
  return least;
}

Nearness nearness(const Curve& curve, double radius_m) {
  const auto& points = curve.points;
  const Chunks<Vector3d> chunks(points);
  const auto apart = static_cast<std::size_t>(kOtherStrand * radius_m / curve.step_m);
  const double reach = kContact * radius_m;
  double least = std::numeric_limits<double>::max();
  std::vector<bool> touching(points.size(), false);
  for (std::size_t a = 0; a < chunks.low.size(); ++a) {
    for (std::size_t b = a; b < chunks.low.size(); ++b) {
      if ((b + 1) * kChunk < a * kChunk + apart || !chunks.near(a, b, reach)) continue;
      for (std::size_t i = a * kChunk; i < std::min(points.size(), (a + 1) * kChunk + 1); ++i) {
        const std::size_t end = std::min(points.size(), (b + 1) * kChunk + 1);
        for (std::size_t j = std::max(b * kChunk, i + apart); j < end; ++j) {
          const double squared = (points[i] - points[j]).squaredNorm();
          least = std::min(least, squared);
          if (squared < reach * reach) touching[i] = touching[j] = true;
        }
      }
    }
  }
  std::size_t run = 0;
  std::size_t longest = 0;
  for (const bool touches : touching) {
    run = touches ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return {std::sqrt(least), static_cast<double>(longest) * curve.step_m};
}

double distance_m(const Curve& a, const Curve& b, double reach_m) {
  const Chunks<Vector3d> of_a(a.points);
  const Chunks<Vector3d> of_b(b.points);
  double least = reach_m * reach_m;
  for (std::size_t i = 0; i < of_a.low.size(); ++i) {
    for (std::size_t j = 0; j < of_b.low.size(); ++j) {
      if (!of_a.near(i, of_b, j, reach_m)) continue;
      const std::size_t end_a = std::min(a.points.size(), (i + 1) * kChunk + 1);
      const std::size_t end_b = std::min(b.points.size(), (j + 1) * kChunk + 1);
      for (std::size_t k = i * kChunk; k < end_a; ++k) {
        for (std::size_t l = j * kChunk; l < end_b; ++l) {
          least = std::min(least, (a.points[k] - b.points[l]).squaredNorm());
        }
      }
    }
  }
  return std::sqrt(least);
}

Centerline nodes_of(const Curve& curve) {
  Centerline nodes{};
  const auto last = curve.points.size() - 1;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const double at = static_cast<double>(k * last) / (kNodes - 1);
    const auto i = std::min(last - 1, static_cast<std::size_t>(at));
    const double t = at - static_cast<double>(i);
    const Vector3d p = (1 - t) * curve.points[i] + t * curve.points[i + 1];
    nodes[k] = {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
  }
  const Point3& a = nodes.front();
  const Point3& b = nodes.back();
  if (std::tie(b.x, b.y, b.z) < std::tie(a.x, a.y, a.z)) std::reverse(nodes.begin(), nodes.end());
  return nodes;
}

}  // namespace flowdlo::synth
