// Quantile: the value that a share of a sample does not exceed.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace flowdlo::geometry {

/// `values` is not empty, `share` in [0, 1]; no interpolation.
[[nodiscard]] float quantile(std::vector<float> values, float share);

/// The middle one, of an even number the upper of the two in the middle. `values` is not empty; its
/// order is lost.
template <class Value>
[[nodiscard]] Value median_of(std::vector<Value>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace flowdlo::geometry
