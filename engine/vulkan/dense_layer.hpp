// DenseLayer: a linear layer's weights, packed the way the kernel that uses it reads them.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "vulkan/plan.hpp"

namespace flowdlo::vulkan {

enum class Packing {
  kPanels,  ///< in a multiple of 16, out of 256: [out/P][in/4][P] texels, f32 or f16; gemm
  kRows,    ///< the same, [out, in] as it is; tile_gemm
  kHalves,  ///< the same, [out, in] of f16; tile_gemm and matrix_gemm
  kNarrow,  ///< in at most 8, out 256: [256, 8], zeros from `in` on; narrow
  kHead,    ///< out at most 4, in 256: [4, 256], zeros from `out` on; flow_step
  kNone,    ///< no kernel takes such a layer
};

struct DenseLayer {
  Packing packing = Packing::kNone;
  int in = 0;
  int out = 0;
  bool halves = false;  ///< of kPanels: its texels are f16
  ops::Tensor weight;
  ops::Tensor bias;
};

inline constexpr int kColumns = 256;  ///< gemm's kernels take columns of y in multiples of these

[[nodiscard]] inline bool is_gemm(Packing packing) {
  return packing == Packing::kPanels || packing == Packing::kRows || packing == Packing::kHalves;
}

/// [out/panel][in/4][panel] texels of four: consecutive k of one column. `weight` is [out, in];
/// `panel` divides out and is a multiple of 8.
[[nodiscard]] std::vector<float> pack_panels(std::span<const float> weight, int out, int in,
                                             int panel);

/// The same of halves, two in the place of each float; every value is an f16.
[[nodiscard]] std::vector<float> pack_half_panels(std::span<const float> weight, int out, int in,
                                                  int panel);

/// Two f16 in the place of each float, nearest even; `weight` has an even size.
[[nodiscard]] std::vector<float> pack_halves(std::span<const float> weight);

/// Whether every value is an f16.
[[nodiscard]] bool are_halves(std::span<const float> weight);

/// Keeps the layer in the plan's constants. A shape that no kernel takes is a fault of the plan.
[[nodiscard]] DenseLayer keep_layer(Plan& plan, std::string_view name, int out, int in,
                                    std::span<const float> weight, std::span<const float> bias);

}  // namespace flowdlo::vulkan
