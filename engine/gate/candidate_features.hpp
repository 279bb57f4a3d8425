// What the calibrated gate weighs, from candidates alone. The order of a frame's candidates is that
// of estimator::list_candidates: the prior of each hypothesis, best first, then the draws.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "gate/candidate.hpp"

namespace flowdlo::gate {

/// In [0, 1]: how much of a share is missing; `most` of it counts as all.
[[nodiscard]] inline double missing(float share, double most) {
  return std::clamp((1 - static_cast<double>(share)) / most, 0.0, 1.0);
}

/// [kDrawFeatures] each in [-1, 1], the first is one: whether to prefer a draw to the prior that it
/// was conditioned on.
inline constexpr std::size_t kDrawFeatures = 26;
[[nodiscard]] std::array<double, kDrawFeatures> draw_features(std::span<const Candidate> candidates,
                                                              std::size_t index);

/// [kHypothesisFeatures] each in [-1, 1], the first is one: which hypothesis to prefer, by what it
/// would return. What a strand field says comes last, and is zero where none was asked.
inline constexpr std::size_t kHypothesisFeatures = 57;
[[nodiscard]] std::array<double, kHypothesisFeatures> hypothesis_features(
    std::span<const Candidate> candidates, std::size_t index);

/// [kClosenessFeatures] about in [-1, 1], the first is one: how near the chosen candidate is to the
/// truth. `lead` is the score by which it leads the best candidate that runs elsewhere. Nothing of
/// it is the model's, so that a fit on frames without one holds for frames with one. What a strand
/// field says comes last, as above.
inline constexpr std::size_t kClosenessFeatures = 47;
[[nodiscard]] std::array<double, kClosenessFeatures> closeness_features(
    std::span<const Candidate> candidates, std::size_t index, double lead);

/// True when more than two rope diameters separate the mean nodes, whichever end comes first.
[[nodiscard]] bool runs_elsewhere(const Candidate& a, const Candidate& b);

}  // namespace flowdlo::gate
