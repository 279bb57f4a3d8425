// PairedBars: Figure 4.2, errors of TrackDLO-init and ours on the scenes where both are valid.
#pragma once

#include <cstdint>
#include <vector>

#include "eval/scene_group.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::eval {

/// Left the index error, right the Frechet distance, by scenario, with TrackDLO-init's coverage in
/// brackets; a logarithmic axis, as they lie decades apart. Empty where it was not run.
[[nodiscard]] Result<std::vector<std::uint8_t>> paired_bars_png(const DataSet& data_set);

}  // namespace flowdlo::eval
