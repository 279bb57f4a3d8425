// RealOverlay: Figure 4.4, curves over frames without truth.
#pragma once

#include <cstdint>
#include <vector>

#include "eval/scene_group.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::eval {

/// A row a frame, at most six: left the prior in grey with the model's draws, in the middle our
/// estimate, right TrackDLO-init. Empty where every frame has a truth.
[[nodiscard]] Result<std::vector<std::uint8_t>> real_overlay_png(const DataSet& data_set);

}  // namespace flowdlo::eval
