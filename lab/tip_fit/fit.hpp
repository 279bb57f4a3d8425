// TipFit: the network that says where a rope's tip lies (refine/tips.hpp), fitted to scenes with
// truth.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tip_fit/sample.hpp"
#include "weights/tip_weights.hpp"

namespace flowdlo::lab {

/// So that half of the tips lie before what it says and half beyond: the least mean distance
/// between both, of tips within what it may say. `rounds` over all samples; the same for the same
/// samples. Expects one sample at least.
[[nodiscard]] weights::TipWeights fit_tips(const std::vector<TipSample>& samples, int rounds);

/// Distances along the rope between tips and where an end is, widths of the rope. Tips farther off
/// than the network may say count as far as it may.
struct TipQuality {
  std::size_t ends = 0;
  double mean = 0;
  double median = 0;
};

/// Of ends as they are; null weights.
[[nodiscard]] TipQuality quality_of(std::span<const TipSample> samples,
                                    const weights::TipWeights* weights);

}  // namespace flowdlo::lab
