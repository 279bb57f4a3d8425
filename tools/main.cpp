// flowdlo: the command line.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <sstream>

#include "bench_command.hpp"
#include "devices_command.hpp"
#include "estimate_command.hpp"
#include "eval_command.hpp"
#include "exit_code.hpp"
#include "flowdlo/version.hpp"
#include "mask_command.hpp"
#include "shell_commands.hpp"
#include "synth_command.hpp"
#include "terminal.hpp"
#include "view_command.hpp"
#include "weights_command.hpp"

namespace flowdlo::tools {
namespace {

/// What CLI11 has to say: help, the version, or what is wrong with the arguments.
int explained(const CLI::App& app, const CLI::ParseError& end) {
  std::ostringstream out;
  std::ostringstream err;
  const int code = app.exit(end, out, err);
  say(stdout, out.str());
  say(stderr, err.str());
  return code == 0 ? 0 : static_cast<int>(ExitCode::kUsage);
}

int run(int argc, char** argv) {
  CLI::App app{"The complete ordered 3D centerline of a rope from one RGB-D frame", "flowdlo"};
  app.set_version_flag("--version", "flowdlo " FLOWDLO_VERSION);
  app.require_subcommand(1);

  auto exit_code = ExitCode::kDone;
  add_estimate_command(app, exit_code);
  add_mask_command(app, exit_code);
  add_view_command(app, exit_code);
  add_devices_command(app);
  add_synth_command(app, exit_code);
  add_weights_command(app, exit_code);
  add_bench_command(app, exit_code);
  add_eval_command(app, exit_code);
  add_shell_commands(app, exit_code);
  if (const auto unknown = unknown_command(app, argc > 1 ? argv[1] : ""); !unknown.empty()) {
    tell_error("{}", unknown);
    return static_cast<int>(ExitCode::kUsage);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& end) {  // --help and --version come this way as well
    return explained(app, end);
  } catch (const std::exception& failure) {
    tell_error("flowdlo: {}\n", failure.what());
    return static_cast<int>(ExitCode::kFailed);
  }
  return static_cast<int>(exit_code);
}

}  // namespace
}  // namespace flowdlo::tools

int main(int argc, char** argv) {
  using namespace flowdlo::tools;
  return finished("flowdlo", run(argc, argv));
}
