// CommandLine: how a program of several commands is started and how it ends.
#pragma once

#include <CLI/App.hpp>

#include "exit_code.hpp"

namespace flowdlo::support {

/// Parses the arguments, which runs the command that they name, and returns the exit code of the
/// process: `exit_code`, as the command left it, kUsage with a sentence where the arguments are
/// wrong, kFailed where something was thrown or standard output did not take everything.
[[nodiscard]] int run_command_line(CLI::App& app, int argc, char** argv, const ExitCode& exit_code);

}  // namespace flowdlo::support
