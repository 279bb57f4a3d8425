// flowdlo mask: masks for frames and pictures that have none.
#pragma once

#include <CLI/App.hpp>

#include "exit_code.hpp"

namespace flowdlo::tools {

/// Adds the subcommand to `app`. When it runs, it sets `exit_code`.
void add_mask_command(CLI::App& app, support::ExitCode& exit_code);

}  // namespace flowdlo::tools
