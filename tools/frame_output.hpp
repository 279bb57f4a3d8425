// FrameOutput: the folder that `flowdlo estimate` writes for one frame, spec section 3.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "estimate_json.hpp"
#include "files/system_calls.hpp"
#include "flowdlo/durability.hpp"
#include "flowdlo/estimate.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "flowdlo/tracker.hpp"

namespace flowdlo::tools {

/// Removes what an earlier run wrote for a frame, estimate.json first: whatever happens next, no
/// result of it stands beside a failure. A folder that is not there is left so. Fails with kIo.
[[nodiscard]] Result<void> forget_results(const std::filesystem::path& folder,
                                          Durability durability = Durability::kSynced,
                                          const files::SystemCalls& calls = files::kernel());

/// What is written beyond the estimate; null: nothing.
struct Extras {
  const Tensors* tensors = nullptr;      ///< as .npy files
  const SeenStrands* strands = nullptr;  ///< in the overlay
  std::span<const Point3> curve{};       ///< as curve.csv; empty: none
};

/// Writes centerline.csv, overlay.png, what `extras` name, and estimate.json last; what an earlier
/// run left is removed before. Fails with kIo: then there is no estimate.json.
[[nodiscard]] Result<void> write_estimate(const std::filesystem::path& folder, const Frame& frame,
                                          const Estimate& estimate, const Extras& extras,
                                          const Provenance& provenance,
                                          Durability durability = Durability::kSynced,
                                          const files::SystemCalls& calls = files::kernel());

/// The same of several ropes: centerline.csv is the first one's, centerline_1.csv and so on the
/// others'. Without numbers they are of a frame on its own.
[[nodiscard]] Result<void> write_ropes(const std::filesystem::path& folder, const Frame& frame,
                                       const TrackedRopes& tracked, const Provenance& provenance,
                                       Durability durability = Durability::kSynced,
                                       const files::SystemCalls& calls = files::kernel());

/// Writes estimate.json with the error, and removes everything else of an earlier run, so that no
/// curve stands beside a failed status. Fails with kIo: then there is no estimate.json.
[[nodiscard]] Result<void> write_failure(const std::filesystem::path& folder, const Error& error,
                                         const Provenance& provenance,
                                         Durability durability = Durability::kSynced,
                                         const files::SystemCalls& calls = files::kernel());

}  // namespace flowdlo::tools
