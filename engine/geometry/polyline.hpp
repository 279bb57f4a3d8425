// Polylines of any dimension: arclength and resampling, Eq. (3.1), (3.2), (3.30).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "flowdlo/centerline.hpp"

namespace flowdlo::geometry {

/// [M] arclength from the first point to each point; the first is 0. Eq. (3.1).
[[nodiscard]] std::vector<float> cumulative_length(std::span<const Eigen::Vector2f> points);
[[nodiscard]] std::vector<float> cumulative_length(std::span<const Eigen::Vector3f> points);

/// `count` points at uniform arclength; first and last are the input's exactly. Eq. (3.2).
/// `points` must hold at least one point; a polyline of no length repeats its first point.
[[nodiscard]] std::vector<Eigen::Vector2f> resample(std::span<const Eigen::Vector2f> points,
                                                    int count);
[[nodiscard]] std::vector<Eigen::Vector3f> resample(std::span<const Eigen::Vector3f> points,
                                                    int count);

/// [63] d_i(X), metres, in double so that no finite centerline overflows. Eq. (3.30).
[[nodiscard]] std::array<double, kNodes - 1> segment_lengths(const Centerline& nodes);

/// L(X), metres. Eq. (3.30).
[[nodiscard]] float length(const Centerline& nodes);

/// Between two points, in double.
[[nodiscard]] inline double distance(const Point3& a, const Point3& b) {
  return std::hypot(static_cast<double>(a.x) - static_cast<double>(b.x),
                    static_cast<double>(a.y) - static_cast<double>(b.y),
                    static_cast<double>(a.z) - static_cast<double>(b.z));
}

/// Mean distance of nodes of the same index, metres, whichever end of `b` comes first; not finite
/// where a node is not.
[[nodiscard]] double mean_distance(const Centerline& a, const Centerline& b);

/// True when every coordinate is finite.
[[nodiscard]] bool all_finite(const Centerline& nodes);

}  // namespace flowdlo::geometry
