// PreviousFile: the nodes in the estimate.json of an earlier run.
#pragma once

#include <filesystem>

#include "flowdlo/centerline.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::tools {

/// Fails with kIo or kBadInput, naming the file and what is wrong with it.
[[nodiscard]] Result<Centerline> read_previous(const std::filesystem::path& file);

}  // namespace flowdlo::tools
