// RegularSize: whether a name is a file that can be read to its end. For C++17 too.
#pragma once

#include <cstdint>
#include <filesystem>

#include "flowdlo/result.hpp"

namespace flowdlo::files {

/// Bytes of the file that `file` names, opened as it would be read but without waiting for anyone.
/// Fails with kIo where there is none, where it may not be read, and where it is a pipe, a device
/// or a folder.
[[nodiscard]] Result<std::uint64_t> regular_size(const std::filesystem::path& file);

}  // namespace flowdlo::files
