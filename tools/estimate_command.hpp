// flowdlo estimate: frames in, centerlines out.
#pragma once

#include <CLI/App.hpp>

#include "exit_code.hpp"

namespace flowdlo::tools {

/// Adds the subcommand to `app`. When it runs, it sets `exit_code`.
void add_estimate_command(CLI::App& app, support::ExitCode& exit_code);

}  // namespace flowdlo::tools
