// flowdlo-train: records, training, resuming, export.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "flowdlo/version.hpp"
#include "train/commands.hpp"

int main(int argc, char** argv) {
  using namespace flowdlo::train;
  CLI::App app{"Training records, training and export of FlowDLO's velocity model and strand field",
               "flowdlo-train"};
  app.set_version_flag("--version", "flowdlo-train " FLOWDLO_VERSION);
  app.require_subcommand(1);
  int exit_code = 0;
  add_records_command(app, exit_code);
  add_train_command(app, argc, argv, exit_code);
  add_resume_command(app, argc, argv, exit_code);
  add_export_command(app, exit_code);
  add_golden_command(app, exit_code);
  add_curves_command(app, exit_code);
#ifdef FLOWDLO_WITH_SYNTH
  add_field_commands(app, argc, argv, exit_code);
  add_refine_command(app, argc, argv, exit_code);
#endif
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& end) {  // --help and --version come this way as well
    return app.exit(end) == 0 ? 0 : 2;
  } catch (const std::exception& failure) {
    fmt::print(stderr, "flowdlo-train: {}\n", failure.what());
    return 1;
  }
  return exit_code;
}
