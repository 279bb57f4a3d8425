// Convolution: its weight as the kernels want it, and how many blocks of an image they take at
// once.
#pragma once

#include <span>

#include "ops/program.hpp"
#include "reference/aligned_floats.hpp"
#include "reference/kernels.hpp"

namespace flowdlo::reference {

/// weight [out, taps, in] in the panels of `kernels`. That of nine taps becomes kTurned matrices,
/// each value rounded once.
[[nodiscard]] AlignedFloats convolution_weight(const Kernels& kernels, int out, int taps, int in,
                                               std::span<const float> weight);

/// Blocks that `convolve` takes at once.
[[nodiscard]] int blocks_together(const ops::Convolution& op);

struct ConvolutionMemory {
  const float* x;
  const float* map;
  const float* weight;  ///< of convolution_weight
  const float* bias;
  float* y;
};

/// `blocks` blocks from `first` on, all in use; at most blocks_together().
void convolve(const Kernels& kernels, const ops::Convolution& op, const ConvolutionMemory& memory,
              int first, int blocks);

}  // namespace flowdlo::reference
