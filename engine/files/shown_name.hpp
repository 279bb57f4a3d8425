// ShownName: a name as it may stand in a message, whatever bytes it holds.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>

namespace flowdlo::files {

/// `text` with every control character written as \xNN, so that it cannot move the cursor, colour
/// or clear a terminal, or turn a line round: C0 and DEL, C1, and Unicode's directions and line
/// separators. Bytes that are no UTF-8 are written so too. Other text is as it was.
[[nodiscard]] std::string shown(std::string_view text);

template <class Path, std::enable_if_t<std::is_same_v<Path, std::filesystem::path>, bool> = true>
[[nodiscard]] std::string shown(const Path& path) {
  return shown(std::string_view(path.native()));
}

/// The same, but line ends and tabs stay: for messages of several lines.
[[nodiscard]] std::string shown_lines(std::string_view text);

}  // namespace flowdlo::files
