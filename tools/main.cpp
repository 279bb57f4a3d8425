// flowdlo: the command line.
#include <CLI/CLI.hpp>

#include "bench_command.hpp"
#include "command_line.hpp"
#include "devices_command.hpp"
#include "estimate_command.hpp"
#include "exit_code.hpp"
#include "flowdlo/version.hpp"
#include "lab_program.hpp"
#include "mask_command.hpp"
#include "shell_commands.hpp"
#include "view_command.hpp"
#include "weights_command.hpp"

int main(int argc, char** argv) {
  using namespace flowdlo;
  if (tools::is_for_lab(argc, argv)) return tools::become_lab(argv);
  CLI::App app{"The complete ordered 3D centerline of a rope from one RGB-D frame", "flowdlo"};
  app.set_version_flag("--version", "flowdlo " FLOWDLO_VERSION);
  app.require_subcommand(1);

  auto exit_code = support::ExitCode::kDone;
  tools::add_estimate_command(app, exit_code);
  tools::add_mask_command(app, exit_code);
  tools::add_view_command(app, exit_code);
  tools::add_devices_command(app);
  tools::add_weights_command(app, exit_code);
  tools::add_bench_command(app, exit_code);
  tools::add_lab_commands(app);
  support::add_shell_commands(app, exit_code, tools::table_with_lab);
  return support::run_command_line(app, argc, argv, exit_code);
}
