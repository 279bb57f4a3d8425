// DrawnFigures: each figure of chapter 4 from one data set, as PNG; empty where the methods that it
// shows were not run. All fail with kInternal when the picture cannot be encoded.
#pragma once

#include <cstdint>
#include <vector>

#include "eval/scene_group.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::eval {

using Png = Result<std::vector<std::uint8_t>>;

/// Figure 4.2, errors of TrackDLO-init and ours on the scenes where both are valid: left the index
/// error, right the Frechet distance, by scenario, with TrackDLO-init's coverage in brackets; a
/// logarithmic axis, as they lie decades apart.
[[nodiscard]] Png paired_bars_png(const DataSet& data_set);

/// Figure 4.4, at most six frames without truth: left the prior in grey with the model's draws, in
/// the middle our estimate, right TrackDLO-init.
[[nodiscard]] Png real_overlay_png(const DataSet& data_set);

/// Table 4.5 as a plot: index error over the steps, velocity and direct; the thesis' curves thin
/// where the groups are its own.
[[nodiscard]] Png sweep_plot_png(const DataSet& data_set);

/// Said confidence against the share of estimates that are right: dots as large as their bin, the
/// diagonal, and how often each confidence is said below.
[[nodiscard]] Png reliability_png(const DataSet& data_set);

}  // namespace flowdlo::eval
