// WholeFile: one file that somebody named, written whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "files/system_calls.hpp"
#include "flowdlo/durability.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::files {

/// Writes `parts` one after another as the file that `file` names: a link is followed, and the
/// file there keeps its mode. It is written under a temporary name in its own folder and renamed;
/// until then what was there before stays, also where this fails. What is no regular file (a pipe,
/// a terminal, /dev/null, our own standard output) is written into instead. Fails with kIo; a pipe
/// that nobody reads for kPatience_ms is one reason.
[[nodiscard]] Result<void> write_file(const std::filesystem::path& file,
                                      const std::vector<std::span<const std::uint8_t>>& parts,
                                      Durability durability = Durability::kSynced,
                                      const SystemCalls& calls = kernel());

[[nodiscard]] Result<void> write_file(const std::filesystem::path& file, std::string_view text,
                                      Durability durability = Durability::kSynced,
                                      const SystemCalls& calls = kernel());

}  // namespace flowdlo::files
