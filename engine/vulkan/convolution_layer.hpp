// ConvolutionWeights: a convolution's weights, packed the way its kernel reads them.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "vulkan/plan.hpp"

namespace flowdlo::vulkan {

inline constexpr int kConvolutionOutputs = 16;  ///< of a workgroup, as in the shader

struct ConvolutionWeights {
  int in = 0;
  int out = 0;
  int taps = 0;  ///< 0: no kernel takes such a layer
  ops::Tensor weight;
  ops::Tensor bias;
};

/// [out/16][D][in/4][D][16] texels of four: consecutive inputs of one output. `weight` is
/// [out, D, D, in]; D is 3 or 1.
[[nodiscard]] std::vector<float> pack_convolution(std::span<const float> weight, int out, int taps,
                                                  int in);

/// Keeps the layer in the plan's constants. A shape that no kernel takes is a fault of the plan.
[[nodiscard]] ConvolutionWeights keep_convolution(Plan& plan, std::string_view name, int out,
                                                  int taps, int in, std::span<const float> weight,
                                                  std::span<const float> bias);

}  // namespace flowdlo::vulkan
