#include "gate/calibrated.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace flowdlo::gate {
namespace {

// In the order of `candidate_features`; fitted by `flowdlo_gate_fit`.
constexpr std::array<double, kCandidateFeatures> kScoreWeights{
    0, 0, -2, -4, -2, -4, -1, -2, -0.5, -1, -0.5, -0.5, -1, -1, -4, -1, -1, -1, -1, -1};
constexpr std::array<double, kProbabilityFeatures> kProbabilityWeights{
    5, 0, -2, -4, -2, -4, -1, -2, -0.5, -1, -0.5, -0.5, -1, -2, -4, -2, -1, -1, -1, -1, 1};

constexpr double kApart = 2;    // rope diameters between candidates that lead elsewhere
constexpr double kSettled = 3;  // score that settles it

double mean_distance_m(const Centerline& a, const Centerline& b) {
  double forward = 0;
  double backward = 0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const auto distance = [&](const Point3& p, const Point3& q) {
      return std::hypot(static_cast<double>(p.x) - static_cast<double>(q.x),
                        static_cast<double>(p.y) - static_cast<double>(q.y),
                        static_cast<double>(p.z) - static_cast<double>(q.z));
    };
    forward += distance(a[i], b[i]) / kNodes;
    backward += distance(a[i], b[kNodes - 1 - i]) / kNodes;
  }
  return std::min(forward, backward);
}

bool elsewhere(const Candidate& a, const Candidate& b) {
  const double apart_m = mean_distance_m(a.nodes, b.nodes);
  return !(apart_m <= 2 * kApart * static_cast<double>(a.radius_m));
}

}  // namespace

double candidate_score(const Candidate& candidate) {
  const auto features = candidate_features(candidate);
  const double score =
      std::inner_product(features.begin(), features.end(), kScoreWeights.begin(), 0.0);
  return std::isfinite(score) ? score : std::numeric_limits<double>::lowest();
}

std::array<double, kProbabilityFeatures> probability_features(std::span<const Candidate> candidates,
                                                              std::size_t chosen,
                                                              std::span<const double> scores) {
  double lead = kSettled;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (i == chosen || !elsewhere(candidates[chosen], candidates[i])) continue;
    lead = std::min(lead, scores[chosen] - scores[i]);
  }
  std::array<double, kProbabilityFeatures> result{};
  const auto features = candidate_features(candidates[chosen]);
  std::copy(features.begin(), features.end(), result.begin());
  result.back() = std::clamp(lead / kSettled, 0.0, 1.0);
  return result;
}

Choice choose_calibrated(std::span<const Candidate> candidates) {
  std::vector<double> scores;
  for (const Candidate& candidate : candidates) scores.push_back(candidate_score(candidate));
  Choice choice;
  choice.chosen =
      static_cast<std::size_t>(std::max_element(scores.begin(), scores.end()) - scores.begin());
  const auto features = probability_features(candidates, choice.chosen, scores);
  const double logit =
      std::inner_product(features.begin(), features.end(), kProbabilityWeights.begin(), 0.0);
  choice.probability = std::isfinite(logit) ? 1 / (1 + std::exp(-logit)) : 0;
  return choice;
}

}  // namespace flowdlo::gate
