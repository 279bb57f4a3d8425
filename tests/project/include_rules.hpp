// Include rules: engine/README.md's table of rooms, and what it forbids.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace flowdlo::project {

/// Room to layer; layer 1 is the top. A room may include itself and rooms of a larger layer.
using Rooms = std::map<std::string, int>;

/// Reads the rows "| layer | `room` | ..." of `markdown`.
[[nodiscard]] Rooms parse_rooms(std::string_view markdown);

struct Include {
  std::string target;
  bool angled = false;  ///< <target>, not "target"
};

/// The #include lines of a source, in order.
[[nodiscard]] std::vector<Include> includes_of(std::string_view source);

/// Why `file` (from engine/, "path/path.cpp") must not have `include`; empty when it may.
[[nodiscard]] std::string complaint(const Rooms& rooms, const std::string& file,
                                    const Include& include);

}  // namespace flowdlo::project
