// File: a weights file as bytes, and what is wrong with one.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "files/regular_file.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::weights {

/// A model of spec section 6 takes 23 MB as f32; what is larger than this is something else.
inline constexpr std::size_t kLargestFile = std::size_t{64} << 20U;

/// The content of a regular file of at most kLargestFile bytes. Fails with kIo, or kBadWeights when
/// it is larger.
[[nodiscard]] Result<files::FileBytes> read_file(const std::filesystem::path& file);

/// kBadWeights with one line a fault: "file: fault; remedy".
[[nodiscard]] Error bad_weights(const std::filesystem::path& file,
                                const std::vector<std::string>& faults);

}  // namespace flowdlo::weights
