// Tree: the project's own files, without what a build leaves.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace flowdlo::project {

/// Paths from the project's root, sorted: what git tracks or would track; without git, all but
/// the folders that .gitignore names.
[[nodiscard]] std::vector<std::string> project_files();

/// The file's bytes; `path` from the project's root.
[[nodiscard]] std::string read(const std::string& path);

/// False for a file with a zero byte.
[[nodiscard]] bool is_text(std::string_view content);

/// Without their line ends.
[[nodiscard]] std::vector<std::string> lines_of(std::string_view content);

}  // namespace flowdlo::project
