// Plots: trials as PNG pictures.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "eval/trial.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::eval {

/// Bars of the mean index error by scenario, a colour a method. Fails with kInternal when the
/// picture cannot be encoded.
[[nodiscard]] Result<std::vector<std::uint8_t>> error_bars_png(std::span<const Trial> trials);

/// Cumulative share of the frames over the index error, on a logarithmic axis, a line a method.
[[nodiscard]] Result<std::vector<std::uint8_t>> error_curve_png(std::span<const Trial> trials);

}  // namespace flowdlo::eval
