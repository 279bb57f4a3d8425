// Weights between libtorch's parameters and the engine's weights files.
#pragma once

#include "flowdlo/result.hpp"
#include "train/velocity_model.hpp"
#include "weights/weights.hpp"

namespace flowdlo::train {

/// The model's parameters by name, in the manifest's order and rounded to f32.
[[nodiscard]] std::vector<weights::Tensor> tensors_of(const VelocityModelImpl& model);

/// Copies the tensors of `weights`, whose variant must be the model's, into it.
void fill(VelocityModelImpl& model, const weights::Weights& weights);

}  // namespace flowdlo::train
