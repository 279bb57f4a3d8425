// TipWeights: the network that says where a rope's tip lies beside the end of its hypothesis. It
// belongs to a strand field: it lies in the field's file as its section "tips"; a file without it
// is one without that network.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "weights/section.hpp"

namespace flowdlo::weights {

inline constexpr std::string_view kTipsVersion = "1";  ///< metadata "tips": of what it is told
inline constexpr int kTipInputs = 148;                 ///< refine/tips.hpp
inline constexpr int kTipHidden = 48;

using TipWeights = Section;

/// bent_manifest() of kTipInputs and kTipHidden.
[[nodiscard]] std::vector<Expected> tips_manifest();

/// Noise, the same values on every machine: for tests of what does not depend on its worth.
[[nodiscard]] TipWeights seeded_tips(std::uint64_t seed);

}  // namespace flowdlo::weights
