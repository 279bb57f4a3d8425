// LabProgram: flowdlo-lab, which lies beside this executable and does what synth and eval are
// asked.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "command_table.hpp"

namespace flowdlo::tools {

/// One line for each of these commands, for --help.
void add_lab_commands(CLI::App& app);

/// Whether the first argument names one of them.
[[nodiscard]] bool is_for_lab(int argc, char** argv);

/// Puts flowdlo-lab in the place of this process, with the same arguments. Returns only where that
/// cannot be: the exit code, after a sentence on standard error that says what to build.
[[nodiscard]] int become_lab(char** argv);

/// The commands of `app`, those of them that are flowdlo-lab's with the options that it says they
/// have. Where it is not there they have none.
[[nodiscard]] std::vector<support::CommandRow> table_with_lab(const CLI::App& app);

}  // namespace flowdlo::tools
