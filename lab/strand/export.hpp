// Export: a trained strand field as the engine reads it, and back.
#pragma once

#include <string>

#include "strand/trainer.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo::strand {

/// The averaged network, each batch norm folded into the convolution before it.
[[nodiscard]] weights::FieldWeights exported(const State& state, const std::string& notes);

/// The way back: a network whose batch norms do nothing but add the folded biases. It says what the
/// engine says of the same weights; for training see start_from().
[[nodiscard]] Network imported(const weights::FieldWeights& weights);

}  // namespace flowdlo::strand
