// LinkWeights: the network that says how likely a strand goes on with another one, or ends. It
// belongs to a strand field: its tensors lie beside the field's, in the same .safetensors file,
// under "links."; a file without them is one without that network.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "weights/weights.hpp"

namespace flowdlo::weights {

inline constexpr std::string_view kLinksVersion = "1";  ///< metadata "links": of what it is told
inline constexpr int kLinkInputs = 65;                  ///< path/link_network.hpp
inline constexpr int kLinkHidden = 48;

struct LinkWeights {
  std::string notes;            ///< free text: command, scenes, what was measured
  std::vector<Tensor> tensors;  ///< exactly links_manifest()'s, in its order

  /// The tensor of that name, without "links.". It must be one of the manifest's.
  [[nodiscard]] const Tensor& at(std::string_view name) const;
};

/// Names and shapes: "links.hidden" [48, 1, 65], "links.bent" [48] and "links.straight" [65] of
/// out = straight x + bent tanh(hidden x).
[[nodiscard]] std::vector<Expected> links_manifest();

/// Noise, the same values on every machine: for tests of what does not depend on its worth.
[[nodiscard]] LinkWeights seeded_links(std::uint64_t seed);

}  // namespace flowdlo::weights
