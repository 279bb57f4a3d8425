// DenseLayer: a linear layer's weights, packed the way the kernel that uses it reads them.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "vulkan/plan.hpp"

namespace flowdlo::vulkan {

enum class Packing {
  kGemm,    ///< in a multiple of 8, out of 256: [out/256][in/4][256] texels; gemm
  kNarrow,  ///< in at most 8, out 256: [256, 8], zeros from `in` on; narrow
  kHead,    ///< out at most 4, in 256: [4, 256], zeros from `out` on; flow_step
  kNone,    ///< no kernel takes such a layer
};

struct DenseLayer {
  Packing packing = Packing::kNone;
  int in = 0;
  int out = 0;
  ops::Tensor weight;
  ops::Tensor bias;
};

inline constexpr int kPanel = 256;  ///< columns of y that lie side by side in gemm's weights

/// [out/256][in/4][256] texels of four: consecutive k of one column. `weight` is [out, in].
[[nodiscard]] std::vector<float> pack_panels(std::span<const float> weight, int out, int in);

/// Keeps the layer in the plan's constants. A shape that no kernel takes is a fault of the plan.
[[nodiscard]] DenseLayer keep_layer(Plan& plan, std::string_view name, int out, int in,
                                    std::span<const float> weight, std::span<const float> bias);

}  // namespace flowdlo::vulkan
