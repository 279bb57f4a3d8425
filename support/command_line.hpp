// CommandLine: how a program of several commands is started and how it ends.
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <string>

#include "exit_code.hpp"

namespace flowdlo::support {

/// A new command of `parent`. What CLI11 makes one of is compiled once, behind this call: it took
/// every file with a command 3 s.
CLI::App* add_command(CLI::App& parent, const std::string& name, const std::string& description);

/// `command` runs `action`, which returns the exit code of the process as a number.
void set_action(CLI::App& command, ExitCode& exit_code, std::function<int()> action);

/// Parses the arguments, which runs the command that they name, and returns the exit code of the
/// process: `exit_code`, as the command left it, kUsage with a sentence where the arguments are
/// wrong, kFailed where something was thrown or standard output did not take everything.
[[nodiscard]] int run_command_line(CLI::App& app, int argc, char** argv, const ExitCode& exit_code);

}  // namespace flowdlo::support
