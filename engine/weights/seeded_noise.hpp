// SeededNoise: tensors of no training, for tests and for networks that are yet to be trained.
#pragma once

#include <cstdint>
#include <vector>

#include "weights/weights.hpp"

namespace flowdlo::weights {

/// Tensors of convolutions, weights [out, taps, in] and biases [out], that keep activations as
/// large as inputs: the same values on every machine.
[[nodiscard]] std::vector<Tensor> seeded_noise(std::vector<Expected> manifest, std::uint64_t seed);

}  // namespace flowdlo::weights
