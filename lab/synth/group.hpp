// Group: which of the nine groups of Sec. 4.1.1 a scene of the thesis split belongs to.
#pragma once

#include <cstdint>
#include <string_view>

#include "synth/synthetic_frame.hpp"

namespace flowdlo::synth {

/// `index` is below scene_count(Split::kThesis, part).
[[nodiscard]] std::string_view thesis_group(Part part, std::uint64_t index);

}  // namespace flowdlo::synth
