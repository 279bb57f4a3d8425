// Quantile: a scale of which given shares of values stay below once and twice.
#pragma once

#include <cstddef>
#include <vector>

namespace flowdlo::lab {

/// One value and what its scale is made from.
struct ScaleRow {
  std::vector<double> features;
  double log_value = 0;
};

/// [features] weights of a log scale, so that 68 % of the values lie below it and 95 % below twice
/// the scale: smoothed quantile regression, both quantiles in one scale.
[[nodiscard]] std::vector<double> fit_scale(const std::vector<ScaleRow>& rows, double ridge);

}  // namespace flowdlo::lab
