// flowdlo eval: frames with truth in, the tables of chapter 4 out.
#pragma once

#include <CLI/App.hpp>

#include "exit_code.hpp"

namespace flowdlo::lab {

/// Adds the subcommand to `app`. When it runs, it sets `exit_code`.
void add_eval_command(CLI::App& app, support::ExitCode& exit_code);

}  // namespace flowdlo::lab
