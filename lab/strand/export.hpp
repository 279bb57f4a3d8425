// Export: a trained strand field as the engine reads it.
#pragma once

#include <string>

#include "strand/trainer.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo::strand {

/// The averaged network, each batch norm folded into the convolution before it.
[[nodiscard]] weights::FieldWeights exported(const State& state, const std::string& notes);

}  // namespace flowdlo::strand
