// RefineWeights: the network that moves nodes deep and aside (room `refine`). It lies in the strand
// field's file as its section "refine"; a file without it is one without that network.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "weights/section.hpp"

namespace flowdlo::weights {

inline constexpr std::string_view kRefineVersion = "2";  ///< metadata "refine": inputs and layers
inline constexpr int kRefineInputs = 96;                 ///< of each station of a strip
inline constexpr int kRefineStem = 32;                   ///< channels behind the first layer
inline constexpr int kRefineWidth = 64;                  ///< channels of each convolution
inline constexpr int kRefineSquares = 4;                 ///< convolutions of 3 x 3
inline constexpr int kRefineOutputs = 16;  ///< columns that kernels take; three are used
/// Whether a node lies on the table is the mean of what is said of so many nodes to both sides as
/// well: a rope rises and falls slowly.
inline constexpr int kRefineAlike = 4;

using RefineWeights = Section;

/// Names and shapes: of each convolution a weight [out, taps, in] and a bias [out]. "stem",
/// "square.0" and further, "head".
[[nodiscard]] std::vector<Expected> refine_manifest();

/// Noise of the size that keeps activations as large as inputs: the same values on every machine.
[[nodiscard]] RefineWeights seeded_refine(std::uint64_t seed);

}  // namespace flowdlo::weights
