// Device: where the tensors live.
#pragma once

#include <torch/torch.h>

#include <string>

#include "flowdlo/result.hpp"
#include "train/precision.hpp"

namespace flowdlo::train {

/// "auto" takes CUDA where it is there. Fails with kNoDevice when "cuda" is asked for and missing.
[[nodiscard]] Result<torch::Device> choose_device(const std::string& wanted);

/// In words, for the metadata: the processor's or the GPU's name, and threads.
[[nodiscard]] std::string describe(torch::Device device);

/// What a model computes in where its recipe asks for `wanted`. A processor without AVX-512 (BW, DQ
/// and VL) has libtorch multiply bf16 by plain loops, a hundred times slower than f32: it computes
/// in f32. The same processor always gets the same answer, so that a resumed run stays exact.
[[nodiscard]] torch::ScalarType compute_type(Precision wanted, torch::Device device);

/// Of the CPU, BLAS included; 0: one a core.
void use_threads(int threads);

}  // namespace flowdlo::train
