#include "geometry/polyline.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/camera.hpp"

namespace flowdlo::geometry {
namespace {

template <class Vector>
std::vector<float> cumulative(std::span<const Vector> points) {
  std::vector<float> lengths(points.size(), 0.0F);
  double total = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    total += (points[i] - points[i - 1]).norm();
    lengths[i] = static_cast<float>(total);
  }
  return lengths;
}

template <class Vector>
std::vector<Vector> resample_any(std::span<const Vector> points, int count) {
  const std::vector<float> lengths = cumulative(points);
  std::vector<Vector> nodes(static_cast<std::size_t>(count), points.front());
  std::size_t segment = 0;
  for (int i = 1; i < count; ++i) {
    const float target =
        static_cast<float>(i) / static_cast<float>(count - 1) * lengths.back();  // Eq. (3.2)
    while (segment + 2 < points.size() && lengths[segment + 1] < target) ++segment;
    if (segment + 1 >= points.size()) break;
    const float span = lengths[segment + 1] - lengths[segment];
    const float alpha = span > 0 ? std::clamp((target - lengths[segment]) / span, 0.0F, 1.0F) : 0;
    nodes[static_cast<std::size_t>(i)] =
        points[segment] + alpha * (points[segment + 1] - points[segment]);
  }
  nodes.back() = points.back();
  return nodes;
}

}  // namespace

std::vector<float> cumulative_length(std::span<const Eigen::Vector2f> points) {
  return cumulative(points);
}

std::vector<float> cumulative_length(std::span<const Eigen::Vector3f> points) {
  return cumulative(points);
}

std::vector<Eigen::Vector2f> resample(std::span<const Eigen::Vector2f> points, int count) {
  return resample_any(points, count);
}

std::vector<Eigen::Vector3f> resample(std::span<const Eigen::Vector3f> points, int count) {
  return resample_any(points, count);
}

std::array<double, kNodes - 1> segment_lengths(const Centerline& nodes) {
  std::array<double, kNodes - 1> lengths{};
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const Eigen::Vector3d from = to_eigen(nodes[i]).cast<double>();
    lengths[i] = (to_eigen(nodes[i + 1]).cast<double>() - from).norm();  // Eq. (3.30)
  }
  return lengths;
}

float length(const Centerline& nodes) {
  const auto lengths = segment_lengths(nodes);
  return static_cast<float>(std::accumulate(lengths.begin(), lengths.end(), 0.0));  // Eq. (3.30)
}

double mean_distance(const Centerline& a, const Centerline& b) {
  double forward = 0;
  double backward = 0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    forward += distance(a[i], b[i]) / kNodes;
    backward += distance(a[i], b[kNodes - 1 - i]) / kNodes;
  }
  return std::min(forward, backward);
}

bool all_finite(const Centerline& nodes) {
  return std::all_of(nodes.begin(), nodes.end(), [](const Point3& node) {
    return std::isfinite(node.x) && std::isfinite(node.y) && std::isfinite(node.z);
  });
}

}  // namespace flowdlo::geometry
