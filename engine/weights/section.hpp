// Section: a small network that lies in a file beside another, under a name of its own.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "weights/weights.hpp"

namespace flowdlo::weights {

/// Its tensors are named "SECTION.TENSOR".
struct Section {
  std::string notes;            ///< free text: command, scenes, what was measured
  std::vector<Tensor> tensors;  ///< exactly those of its manifest, in its order

  /// The tensor "SECTION.`wanted`". It must be one of the manifest's.
  [[nodiscard]] const Tensor& at(std::string_view wanted) const;
};

/// Names and shapes of a network with one output, out = straight x + bent tanh(hidden x):
/// "hidden" [hidden, 1, inputs], "bent" [hidden] and "straight" [inputs]
/// (weights/bent_network.hpp).
[[nodiscard]] std::vector<Expected> bent_manifest(std::string_view section, int inputs, int hidden);

}  // namespace flowdlo::weights
