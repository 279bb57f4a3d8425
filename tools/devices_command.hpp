// flowdlo devices, alias doctor: what this machine offers, and which device "auto" takes.
#pragma once

#include <CLI/App.hpp>

namespace flowdlo::tools {

/// Adds the subcommand to `app`. It cannot fail.
void add_devices_command(CLI::App& app);

}  // namespace flowdlo::tools
