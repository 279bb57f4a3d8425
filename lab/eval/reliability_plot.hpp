// ReliabilityPlot: said confidence against the share of estimates that are right.
#pragma once

#include <cstdint>
#include <vector>

#include "eval/scene_group.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::eval {

/// Dots as large as their bin, the diagonal, and how often each confidence is said below. Empty
/// without truth.
[[nodiscard]] Result<std::vector<std::uint8_t>> reliability_png(const DataSet& data_set);

}  // namespace flowdlo::eval
