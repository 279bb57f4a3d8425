// flowdlo eval: frames with truth in, the tables of chapter 4 out.
#pragma once

#include <CLI/App.hpp>

#include "exit_code.hpp"

namespace flowdlo::tools {

/// Adds the subcommand to `app`. When it runs, it sets `exit_code`.
void add_eval_command(CLI::App& app, ExitCode& exit_code);

}  // namespace flowdlo::tools
