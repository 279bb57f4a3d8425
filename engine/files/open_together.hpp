// OpenTogether: several files of a folder as they were at one moment.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "files/regular_file.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::files {

/// One file of a folder: open, absent (no file and no error), or not to be opened.
struct TogetherFile {
  std::optional<RegularFile> file;
  std::optional<Error> error;
};

/// Opens `names` in `folder` so that no FolderUpdate came between any two of them; one that was cut
/// off counts as made. Read-only folders do as well, nothing is written and nobody is kept waiting.
/// Fails with kIo where the folder cannot be opened or changes all the time, and with kBadInput
/// where the record of a change is damaged.
[[nodiscard]] Result<std::vector<TogetherFile>> open_together(const std::filesystem::path& folder,
                                                              std::span<const char* const> names,
                                                              const SystemCalls& calls = kernel());

}  // namespace flowdlo::files
