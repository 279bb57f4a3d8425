// Layer: the weights of one layer in the memory order that its kernel reads.
#pragma once

#include <span>

#include "reference/aligned_floats.hpp"
#include "reference/kernels.hpp"

namespace flowdlo::reference {

inline constexpr int kPartColumns =
    64;  ///< of a linear layer's result: what a thread takes at least

struct Layer {
  AlignedFloats weight;  ///< panels, columns, or [out, in] for the head
  AlignedFloats bias;
  AlignedHalves halves{};  ///< in place of `weight`: panels, for kernels that widen halves
};

/// Of weight [out, in] and bias [out]. Halves where the kernels widen them and no value is changed
/// by it.
[[nodiscard]] Layer linear_layer(const Kernels& kernels, int out, int in,
                                 std::span<const float> weight, std::span<const float> bias);

}  // namespace flowdlo::reference
