// Quantile: the value that a share of a sample does not exceed.
#pragma once

#include <vector>

namespace flowdlo::geometry {

/// `values` is not empty, `share` in [0, 1]; no interpolation.
[[nodiscard]] float quantile(std::vector<float> values, float share);

}  // namespace flowdlo::geometry
