// The synth command of a build without Embree.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "synth_command.hpp"
#include "terminal.hpp"

namespace flowdlo::tools {

void add_synth_command(CLI::App& app, ExitCode& exit_code) {
  auto* command = app.add_subcommand("synth", "Synthetic frames with truth (not in this build)");
  command->allow_extras();
  command->callback([&exit_code] {
    tell_error(
        "synth: not part of this flowdlo: {}; install libembree-dev, then configure "
        "and build again\n",
        FLOWDLO_SYNTH_LACKS);
    exit_code = ExitCode::kFailed;
  });
}

}  // namespace flowdlo::tools
