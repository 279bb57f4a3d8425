#include "gate_fit/true_ring.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "geometry/camera.hpp"
#include "geometry/polyline.hpp"

namespace flowdlo::lab {
namespace {

constexpr int kBeginnings = 256;

/// A ring's nodes, 63 next to 0, from a share of its length on.
Centerline ring_from(double share, std::span<const Eigen::Vector3f> closed,
                     std::span<const float> length_m) {
  Centerline nodes;
  for (std::size_t i = 0; i < kNodes; ++i) {
    double whole = 0;
    const double at = std::modf(share + static_cast<double>(i) / kNodes, &whole);
    const auto at_m = static_cast<float>(at) * length_m.back();
    const auto above = std::upper_bound(length_m.begin() + 1, length_m.end() - 1, at_m);
    const auto k = static_cast<std::size_t>(above - length_m.begin());
    const float span_m = length_m[k] - length_m[k - 1];
    const float t = span_m > 0 ? (at_m - length_m[k - 1]) / span_m : 0;
    nodes[i] = geometry::to_point((1 - t) * closed[k - 1] + t * closed[k]);
  }
  return nodes;
}

}  // namespace

Centerline true_ring(const Centerline& ring, const Centerline& found) {
  std::vector<Eigen::Vector3f> closed;
  for (const Point3& node : ring) closed.push_back(geometry::to_eigen(node));
  closed.push_back(closed.front());
  const auto length_m = geometry::cumulative_length(closed);
  Centerline best = ring;
  for (int k = 0; k < kBeginnings; ++k) {
    const auto turned = ring_from(static_cast<double>(k) / kBeginnings, closed, length_m);
    if (geometry::mean_distance(turned, found) < geometry::mean_distance(best, found)) {
      best = turned;
    }
  }
  return best;
}

}  // namespace flowdlo::lab
