// SweepSheet: Figure 4.5 and Table 4.5 as pictures: what more Euler steps change.
#pragma once

#include <cstdint>
#include <vector>

#include "eval/scene_group.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::eval {

/// Index error over the steps, velocity and direct; the thesis' curves dashed where the groups are
/// its own. Empty where neither was run.
[[nodiscard]] Result<std::vector<std::uint8_t>> sweep_plot_png(const DataSet& data_set);

/// A tangle and an S, the first draw at 1, 4, 10 and 20 steps, a row for velocity and one for
/// direct prediction each. Empty where neither was run.
[[nodiscard]] Result<std::vector<std::uint8_t>> sweep_sheet_png(const DataSet& data_set);

}  // namespace flowdlo::eval
