// File: whole files in and out; a file that is written appears complete or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "flowdlo/result.hpp"

namespace flowdlo::weights {

/// A model of spec section 6 takes 23 MB as f32; what is larger than this is something else.
inline constexpr std::size_t kLargestFile = std::size_t{64} << 20U;

struct FileBytes {
  std::unique_ptr<std::uint8_t[]> data;  ///< aligned for every scalar type
  std::size_t size = 0;

  [[nodiscard]] std::span<const std::uint8_t> view() const { return {data.get(), size}; }
};

/// The content of a regular file of at most kLargestFile bytes. Fails with kIo, or kBadWeights when
/// it is larger.
[[nodiscard]] Result<FileBytes> read_file(const std::filesystem::path& file);

/// Writes `parts` one after another under a temporary name beside `file`, then renames it. Fails
/// with kIo; the temporary is removed then.
[[nodiscard]] Result<void> write_file(const std::filesystem::path& file,
                                      const std::vector<std::span<const std::uint8_t>>& parts);

/// kBadWeights with one line a fault: "file: fault; remedy".
[[nodiscard]] Error bad_weights(const std::filesystem::path& file,
                                const std::vector<std::string>& faults);

}  // namespace flowdlo::weights
