// Where the weights lie that Config leaves unnamed.
#pragma once

#include <filesystem>

#include "flowdlo/result.hpp"

namespace flowdlo::estimator {

/// share/flowdlo/flowdlo.fdw beside the library (or the program it is linked into): up to three
/// folders above it. Fails with kBadWeights, listing where it looked.
[[nodiscard]] Result<std::filesystem::path> default_weights();

/// The strand field's weights that belong to the model's: `field.safetensors` in their folder;
/// empty where there is none.
[[nodiscard]] std::filesystem::path field_beside(const std::filesystem::path& weights);

}  // namespace flowdlo::estimator
