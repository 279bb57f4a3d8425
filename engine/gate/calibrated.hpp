// The calibrated gate: the candidate that a score fitted on synthetic scenes prefers, with the
// probability that it is close to the truth.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "gate/candidate.hpp"

namespace flowdlo::gate {

/// A mean index error below this, Eq. (4.1), is what the probability promises.
inline constexpr double kCloseError_m = 0.01;

struct Choice {
  std::size_t chosen = 0;  ///< index among the candidates; ties go to the lower one
  double probability = 0;  ///< [0, 1] that its index error is below kCloseError_m, either way round
};

/// Linear in candidate_features; higher is better. The worst there is when anything is not finite.
[[nodiscard]] double candidate_score(const Candidate& candidate);

/// [kProbabilityFeatures] what the probability is made from: the winner's features, and by how much
/// the best candidate that leads elsewhere trails it.
inline constexpr std::size_t kProbabilityFeatures = kCandidateFeatures + 1;
[[nodiscard]] std::array<double, kProbabilityFeatures> probability_features(
    std::span<const Candidate> candidates, std::size_t chosen, std::span<const double> scores);

/// `candidates` is not empty.
[[nodiscard]] Choice choose_calibrated(std::span<const Candidate> candidates);

}  // namespace flowdlo::gate
