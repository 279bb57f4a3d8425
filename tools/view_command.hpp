// flowdlo view: frames and what was made of them, in a browser of this computer.
#pragma once

#include <CLI/App.hpp>

#include "exit_code.hpp"

namespace flowdlo::tools {

/// Adds the subcommand to `app`. When it runs, it sets `exit_code`.
void add_view_command(CLI::App& app, support::ExitCode& exit_code);

}  // namespace flowdlo::tools
