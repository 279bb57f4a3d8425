// The velocity model of Sec. 3.4 as two ONNX graphs: what a frame fixes, and one step.
#pragma once

#include <string>

#include "weights/weights.hpp"

namespace flowdlo::peers {

/// prior [M, 4] and points [256, 4], normalised, and masked [1, 256] (0 or minus infinity's
/// stand-in) to still [M, 256] = e_j + E_prior + E_h, key [1, 8, 32, 256], value [1, 8, 256, 32]. M
/// = 64 draws.
[[nodiscard]] std::string onnx_conditions(const weights::Weights& weights, int draws);

/// state [M, 3], time [1, 256], features [M, channels], still, key, value and bias [1, 1, 1, 256]
/// to output [M, head channels].
[[nodiscard]] std::string onnx_step(const weights::Weights& weights, int draws);

}  // namespace flowdlo::peers
