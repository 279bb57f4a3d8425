// Manual: the manual pages of a program, section 1.
#pragma once

#include <string>
#include <vector>

#include "command_table.hpp"

namespace flowdlo::support {

struct ManualPage {
  std::string file;  ///< "flowdlo-weights-info.1"
  std::string text;  ///< roff with the man macros
};

/// A page for the program and one for each of its commands.
[[nodiscard]] std::vector<ManualPage> manual(const std::string& name, const std::string& version,
                                             const std::vector<CommandRow>& table);

}  // namespace flowdlo::support
