#include "estimator/confidence.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/camera.hpp"
#include "geometry/polyline.hpp"

namespace flowdlo::estimator {
namespace {

/// Root mean square distance of the finite draws to their mean, a node.
std::array<float, kNodes> spread(const std::vector<Centerline>& draws) {
  std::array<float, kNodes> deviation{};
  for (std::size_t node = 0; node < kNodes; ++node) {
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    float count = 0;
    for (const Centerline& draw : draws) {
      if (!geometry::all_finite(draw)) continue;
      mean += geometry::to_eigen(draw[node]);
      count += 1;
    }
    if (count < 2) continue;
    mean /= count;
    float square = 0;
    for (const Centerline& draw : draws) {
      if (geometry::all_finite(draw)) {
        square += (geometry::to_eigen(draw[node]) - mean).squaredNorm();
      }
    }
    deviation[node] = std::sqrt(square / (count - 1));
  }
  return deviation;
}

}  // namespace

float confidence(float mask_agreement, float margin, std::span<const std::uint8_t> support) {
  const auto supported = std::count(support.begin(), support.end(), std::uint8_t{1});
  const float share =
      support.empty() ? 0.0F : static_cast<float>(supported) / static_cast<float>(support.size());
  const float value = mask_agreement * (0.5F + 0.5F * margin) * (0.5F + 0.5F * share);
  return std::isfinite(value) ? std::clamp(value, 0.0F, 1.0F) : 0.0F;
}

std::array<float, kNodes> node_sigma(Source source, int draw, const flow::Prediction& prediction,
                                     const prior::Prior& prior) {
  if (source == Source::kPrior) return prior.sigma_m;
  if (!prediction.sigma_m.empty()) return prediction.sigma_m[static_cast<std::size_t>(draw)];
  std::array<float, kNodes> sigma_m = spread(prediction.draws);
  for (std::size_t node = 0; node < kNodes; ++node) {
    if (prior.support[node] != 0) sigma_m[node] = std::max(sigma_m[node], prior.sigma_m[node]);
  }
  return sigma_m;
}

}  // namespace flowdlo::estimator
