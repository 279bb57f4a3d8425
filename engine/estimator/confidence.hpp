// Confidence and uncertainty of an estimate, from what needs no truth.
#pragma once

#include <array>
#include <cstddef>

#include "flow/sampler.hpp"
#include "flowdlo/estimate.hpp"
#include "gate/candidate.hpp"
#include "prior/prior.hpp"

namespace flowdlo::estimator {

/// [kConfidenceFeatures] what the probability is made from, each in [0, 1]: one, the margin, and
/// then what speaks against the prior of a hypothesis.
inline constexpr std::size_t kConfidenceFeatures = 16;
[[nodiscard]] std::array<double, kConfidenceFeatures> confidence_features(
    const gate::Candidate& prior, double lead);

/// In [0, 1]: the probability that the best traversal visits the rope in order and leaves no loop
/// out, whichever end comes first, when `lead` separates it from the next. Errs towards doubt:
/// wrong ones counted eightfold when it was fitted. Low for a closed ring, whose ends are a guess.
/// 0 when anything is not finite.
[[nodiscard]] float confidence(const gate::Candidate& prior, double lead);

/// [64] metres. A prior's own sigma; for a prediction the model's fourth head where it has one,
/// otherwise the spread of the draws, never below the prior's sigma of a supported node.
[[nodiscard]] std::array<float, kNodes> node_sigma(Source source, int draw,
                                                   const flow::Prediction& prediction,
                                                   const prior::Prior& prior);

}  // namespace flowdlo::estimator
