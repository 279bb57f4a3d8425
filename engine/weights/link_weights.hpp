// LinkWeights: the network that says how likely a strand goes on with another one, or ends. It
// belongs to a strand field: it lies in the field's file as its section "links"; a file without it
// is one without that network.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "weights/section.hpp"

namespace flowdlo::weights {

inline constexpr std::string_view kLinksVersion = "1";  ///< metadata "links": of what it is told
inline constexpr int kLinkInputs = 65;                  ///< path/link_network.hpp
inline constexpr int kLinkHidden = 48;

using LinkWeights = Section;

/// bent_manifest() of kLinkInputs and kLinkHidden.
[[nodiscard]] std::vector<Expected> links_manifest();

/// Noise, the same values on every machine: for tests of what does not depend on its worth.
[[nodiscard]] LinkWeights seeded_links(std::uint64_t seed);

}  // namespace flowdlo::weights
