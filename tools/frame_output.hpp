// FrameOutput: the folder that `flowdlo estimate` writes for one frame, spec section 3.
#pragma once

#include <filesystem>
#include <string>

#include "estimate_json.hpp"
#include "flowdlo/estimate.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::tools {

/// Writes centerline.csv, overlay.png, the .npy files when there are `tensors`, and estimate.json
/// last; what an earlier run left and this one does not write is removed. Fails with kIo.
[[nodiscard]] Result<void> write_estimate(const std::filesystem::path& folder, const Frame& frame,
                                          const Estimate& estimate, const Tensors* tensors,
                                          const Provenance& provenance);

/// Writes estimate.json with the error, and removes everything else of an earlier run, so that no
/// curve stands beside a failed status. Fails with kIo.
[[nodiscard]] Result<void> write_failure(const std::filesystem::path& folder, const Error& error,
                                         const Provenance& provenance);

}  // namespace flowdlo::tools
