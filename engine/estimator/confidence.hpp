// Confidence and uncertainty of an estimate, from what needs no truth. Not calibrated.
#pragma once

#include <array>
#include <span>

#include "flow/sampler.hpp"
#include "flowdlo/estimate.hpp"
#include "prior/prior.hpp"

namespace flowdlo::estimator {

/// In [0, 1]: mask agreement S_M of the returned curve, times how clearly the traversal won
/// (`margin` in [0, 1], at worst one half), times the share of nodes with support (at worst half).
[[nodiscard]] float confidence(float mask_agreement, float margin,
                               std::span<const std::uint8_t> support);

/// [64] metres. A prior's own sigma; for a prediction the model's fourth head where it has one,
/// otherwise the spread of the draws, never below the prior's sigma of a supported node.
[[nodiscard]] std::array<float, kNodes> node_sigma(Source source, int draw,
                                                   const flow::Prediction& prediction,
                                                   const prior::Prior& prior);

}  // namespace flowdlo::estimator
