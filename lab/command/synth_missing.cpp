// The synth command of a build without Embree.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <cstdio>

#include "command/synth_command.hpp"
#include "command_line.hpp"
#include "terminal.hpp"

namespace flowdlo::lab {

void add_synth_command(CLI::App& app, support::ExitCode& exit_code) {
  auto* command =
      support::add_command(app, "synth", "Synthetic frames with truth (not in this build)");
  command->allow_extras();
  command->callback([&exit_code] {
    support::tell_error(
        "synth: not part of this flowdlo: {}; install libembree-dev, then configure "
        "and build again\n",
        FLOWDLO_SYNTH_LACKS);
    exit_code = support::ExitCode::kFailed;
  });
}

}  // namespace flowdlo::lab
