// Completion: a shell's own script that completes the command's words.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command_table.hpp"

namespace flowdlo::support {

enum class Shell { kBash, kZsh, kFish };

/// Completes commands, options and choices of the program `name`, and files elsewhere.
[[nodiscard]] std::string completion(Shell shell, const std::string& name,
                                     const std::vector<CommandRow>& table);

}  // namespace flowdlo::support
