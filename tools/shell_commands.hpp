// flowdlo completion and flowdlo manual: what a shell and man(1) are told of the command.
#pragma once

#include <CLI/App.hpp>

#include "exit_code.hpp"

namespace flowdlo::tools {

/// Adds both to `app`. When one runs, it sets `exit_code`.
void add_shell_commands(CLI::App& app, ExitCode& exit_code);

/// What to say of a first word that is no command of `app`, with the nearest one; empty where it is
/// one, or an option.
[[nodiscard]] std::string unknown_command(const CLI::App& app, const std::string& word);

}  // namespace flowdlo::tools
