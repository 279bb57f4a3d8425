// DenseLayer: a linear layer's weights, packed the way the kernel that uses it reads them.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "vulkan/plan.hpp"

namespace flowdlo::vulkan {

enum class Packing {
  kPanels,  ///< in a multiple of 16, out of 256: [out/P][in/4][P] texels, or half as many pairs;
            ///< gemm
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
  bool pairs = false;  ///< of kPanels: a word holds two weights
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

/// Whether every value fits half a word of pack_pairs: zero, or 11 significant bits and a magnitude
/// of at least 2^-31 and below 2.
[[nodiscard]] bool fit_pairs(std::span<const float> weight);

/// The same of two columns a texel, each value in half a word, exact but for zero, which becomes
/// 2^-31. All values fit; the shader gemm says which bits are whose.
[[nodiscard]] std::vector<float> pack_pairs(std::span<const float> weight, int out, int in,
                                            int panel);

/// Two f16 in the place of each float, nearest even; `weight` has an even size.
[[nodiscard]] std::vector<float> pack_halves(std::span<const float> weight);

/// Whether every value is an f16.
[[nodiscard]] bool are_halves(std::span<const float> weight);

/// Keeps the layer in the plan's constants. A shape that no kernel takes is a fault of the plan.
[[nodiscard]] DenseLayer keep_layer(Plan& plan, std::string_view name, int out, int in,
                                    std::span<const float> weight, std::span<const float> bias);

}  // namespace flowdlo::vulkan
