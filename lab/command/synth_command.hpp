// flowdlo synth: synthetic frames with truth.
#pragma once

#include <CLI/App.hpp>

#include "exit_code.hpp"

namespace flowdlo::lab {

/// Adds the subcommand to `app`. When it runs, it sets `exit_code`. Built without Embree, the
/// command says so in one sentence and fails.
void add_synth_command(CLI::App& app, support::ExitCode& exit_code);

}  // namespace flowdlo::lab
