#include "estimator/confidence.hpp"

#include <algorithm>
#include <cmath>

#include "estimator/hypotheses.hpp"
#include "geometry/camera.hpp"
#include "geometry/polyline.hpp"

namespace flowdlo::estimator {
namespace {

// In the order of `confidence_features`. Fitted on synthetic scenes by
// `flowdlo-lab scenes fit --scenes 150 --wide 1000`; the first, 1.136 there, is lowered by 0.35:
// it errs towards doubt.
constexpr std::array<double, kConfidenceFeatures> kConfidenceWeights{
    0.786, 2.036,  -3.839, 0.000,  -1.111, -1.407, -1.035, -0.379,
    0.000, -3.111, -1.330, -0.572, -2.900, -2.430, -4.093, 0.000};
constexpr double kRingConfidence = 0.2;  // no fit tells it: rings are rare, their ends unknown

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

bool known(const gate::Candidate& prior) {
  const gate::TubeScore& tube = prior.tube;
  return std::isfinite(tube.mask_recall + tube.mask_precision + tube.depth_agreement +
                       tube.crossing_agreement + tube.least_sine + tube.bending +
                       tube.sharpest_bend + prior.longest_gap + prior.hidden_ends +
                       prior.buried_ends);
}

}  // namespace

std::array<double, kConfidenceFeatures> confidence_features(const gate::Candidate& prior,
                                                            double lead) {
  const gate::TubeScore& tube = prior.tube;
  const auto missing = [](float share, double most) {
    return std::min(1.0, (1 - static_cast<double>(share)) / most);
  };
  const auto some = [](float value, double most) {
    return std::min(1.0, static_cast<double>(value) / most);
  };
  return {1,
          static_cast<double>(margin(lead)),
          missing(tube.mask_recall, 0.05),
          missing(tube.mask_recall, 0.15),
          missing(tube.mask_precision, 0.1),
          missing(tube.depth_agreement, 0.1),
          missing(tube.crossing_agreement, 0.2),
          missing(tube.least_sine, 1) * missing(tube.least_sine, 1),
          some(tube.bending, 5),
          some(tube.sharpest_bend, 1),
          some(prior.longest_gap, 15),
          static_cast<double>(prior.hidden_ends),
          static_cast<double>(prior.buried_ends),
          missing(prior.supported, 0.5),
          some(tube.overlap_share, 0.5),
          some(tube.hidden_share, 0.3)};
}

float confidence(const gate::Candidate& prior, double lead) {
  if (!known(prior) || !std::isfinite(lead)) return 0;
  const auto features = confidence_features(prior, lead);
  double logit = 0;
  for (std::size_t i = 0; i < features.size(); ++i) logit += kConfidenceWeights[i] * features[i];
  const double share = 1 / (1 + std::exp(-logit));
  return static_cast<float>(prior.ring > 0 ? kRingConfidence * share : share);
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
