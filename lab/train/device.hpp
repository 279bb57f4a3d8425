// Device: where the tensors live.
#pragma once

#include <torch/torch.h>

#include <string>

#include "flowdlo/result.hpp"

namespace flowdlo::train {

/// "auto" takes CUDA where it is there. Fails with kNoDevice when "cuda" is asked for and missing.
[[nodiscard]] Result<torch::Device> choose_device(const std::string& wanted);

/// In words, for the metadata: the processor's or the GPU's name, and threads.
[[nodiscard]] std::string describe(torch::Device device);

/// Of the CPU, BLAS included; 0: one a core.
void use_threads(int threads);

}  // namespace flowdlo::train
