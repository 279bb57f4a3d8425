#include "projected_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace flowdlo::tools {
namespace {

constexpr double kLast = kNodes - 1;

float cross(const Spot& a, const Spot& b) { return a.x * b.y - a.y * b.x; }

}  // namespace

ProjectedCurve::ProjectedCurve(const Centerline& nodes, const Intrinsics& camera, float zoom) {
  constexpr float kFarOutside_px = 1.0e5F;  // keeps the pen's fixed-point numbers in range
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    const auto& [x, y, z] = nodes[j];
    // The centre of the top left pixel is (0, 0) in the camera and (zoom - 1) / 2 in the picture.
    const float u = (camera.fx * x / z + camera.cx + 0.5F) * zoom - 0.5F;
    const float v = (camera.fy * y / z + camera.cy + 0.5F) * zoom - 0.5F;
    if (!(z > 0) || !std::isfinite(u) || !std::isfinite(v)) {
      drawable_ = false;
      return;
    }
    nodes_px_[j] = {std::clamp(u, -kFarOutside_px, kFarOutside_px),
                    std::clamp(v, -kFarOutside_px, kFarOutside_px)};
    depth_m_[j] = z;
    if (j > 0) {
      const auto step = nodes_px_[j] - nodes_px_[j - 1];
      length_px_[j] = length_px_[j - 1] + std::hypot(step.x, step.y);
    }
  }
}

Spot ProjectedCurve::at(double position) const {
  const auto before = static_cast<std::size_t>(std::clamp(position, 0.0, kLast));
  if (before + 1 >= nodes_px_.size()) return nodes_px_.back();
  const auto fraction = static_cast<float>(position - static_cast<double>(before));
  return nodes_px_[before] + fraction * (nodes_px_[before + 1] - nodes_px_[before]);
}

std::vector<Spot> ProjectedCurve::piece(double from, double to) const {
  from = std::clamp(from, 0.0, kLast);
  to = std::clamp(to, from, kLast);
  std::vector<Spot> points = {at(from)};
  for (auto j = static_cast<std::size_t>(from) + 1; static_cast<double>(j) < to; ++j) {
    points.push_back(nodes_px_[j]);
  }
  points.push_back(at(to));
  return points;
}

double ProjectedCurve::advanced(double position, float distance_px) const {
  const auto before =
      std::min(static_cast<std::size_t>(std::clamp(position, 0.0, kLast)), nodes_px_.size() - 2);
  const auto fraction = static_cast<float>(position - static_cast<double>(before));
  const float target =
      length_px_[before] + fraction * (length_px_[before + 1] - length_px_[before]) + distance_px;
  if (target <= 0) return 0;
  const auto above = std::upper_bound(length_px_.begin(), length_px_.end(), target);
  if (above == length_px_.end()) return kLast;
  const auto next = static_cast<std::size_t>(above - length_px_.begin());
  const float step = length_px_[next] - length_px_[next - 1];
  return static_cast<double>(next - 1) + (target - length_px_[next - 1]) / step;
}

std::vector<Crossing> ProjectedCurve::crossings() const {
  std::vector<Crossing> found;
  for (std::size_t i = 0; i + 1 < nodes_px_.size(); ++i) {
    const auto along_i = nodes_px_[i + 1] - nodes_px_[i];
    for (std::size_t k = i + 2; k + 1 < nodes_px_.size(); ++k) {
      const auto along_k = nodes_px_[k + 1] - nodes_px_[k];
      const float area = cross(along_i, along_k);
      if (area == 0) continue;  // parallel: side by side, not across
      const auto gap = nodes_px_[k] - nodes_px_[i];
      const float t = cross(gap, along_k) / area;
      const float s = cross(gap, along_i) / area;
      if (t < 0 || t >= 1 || s < 0 || s >= 1) continue;
      const float depth_i = depth_m_[i] + t * (depth_m_[i + 1] - depth_m_[i]);
      const float depth_k = depth_m_[k] + s * (depth_m_[k + 1] - depth_m_[k]);
      const bool i_is_upper = depth_i <= depth_k;
      const float sine =
          std::abs(area) / (std::hypot(along_i.x, along_i.y) * std::hypot(along_k.x, along_k.y));
      found.push_back({i_is_upper ? static_cast<double>(i) + t : static_cast<double>(k) + s,
                       std::min(depth_i, depth_k), sine});
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Crossing& a, const Crossing& b) { return a.depth_m > b.depth_m; });
  return found;
}

}  // namespace flowdlo::tools
