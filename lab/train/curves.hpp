// Curves: a run's log as one page of plots.
#pragma once

#include <filesystem>

#include "flowdlo/result.hpp"

namespace flowdlo::train {

/// folder/curves.png from steps.csv and validation.csv beside it: losses, and errors beside the
/// prior's. Fails with kIo.
[[nodiscard]] Result<void> plot_curves(const std::filesystem::path& folder);

}  // namespace flowdlo::train
