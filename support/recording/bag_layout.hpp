// BagLayout: is a file a whole ROS 1 bag? C++17: see bag.hpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <istream>
#include <string>

#include "flowdlo/result.hpp"

namespace flowdlo::recording {

/// Walks every record of `file`: lengths stay inside, chunks hold what the index says, the index
/// is there. Fails with kIo, or with kBadInput that tells apart what is no bag, what was cut off,
/// what was never closed, and what is damaged.
[[nodiscard]] Result<void> check_bag_layout(const std::filesystem::path& file);

/// The same of `size` bytes that `stream` gives; `who` names them.
[[nodiscard]] Result<void> check_bag_layout(std::istream& stream, std::uint64_t size,
                                            const std::string& who);

}  // namespace flowdlo::recording
