// FileBytes: a whole file in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "flowdlo/result.hpp"

namespace flowdlo::frame {

/// The bytes of a regular file that is neither empty nor over `max_bytes`; otherwise kIo (missing,
/// unreadable, not a file) or kBadInput (empty, too large). The message names the file.
[[nodiscard]] Result<std::vector<std::uint8_t>> read_file(const std::filesystem::path& file,
                                                          std::size_t max_bytes);

}  // namespace flowdlo::frame
