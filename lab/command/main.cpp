// flowdlo-lab: scenes with truth, and what is measured and fitted on them. `flowdlo synth` and
// `flowdlo eval` run this program.
#include <CLI/CLI.hpp>
#include <string>

#include "command/eval_command.hpp"
#include "command/report_commands.hpp"
#include "command/synth_command.hpp"
#include "command_line.hpp"
#include "flowdlo/version.hpp"
#include "shell_commands.hpp"

namespace flowdlo::lab {
namespace {

constexpr const char* kName = "flowdlo-lab";

/// Under the name that it was called by: `flowdlo eval --help` is about flowdlo.
std::string called(const char* program) {
  return std::string(program).ends_with(kName) ? kName : "flowdlo";
}

#ifdef FLOWDLO_WITH_REPORTS
void add_reports(CLI::App& app, support::ExitCode& exit_code) {
  add_make_scene(app, exit_code);
  add_curve_report(app, exit_code);
  add_hostile_report(app, exit_code);
#ifdef FLOWDLO_WITH_SYNTH  // what is about rendered scenes
  add_scenes(app, exit_code);
  add_gate_fit(app, exit_code);
  add_energy_fit(app, exit_code);
  add_link_fit(app, exit_code);
  add_tip_fit(app, exit_code);
  add_field_report(app, exit_code);
  add_reading_report(app, exit_code);
  add_ropes_report(app, exit_code);
  add_one_rope_report(app, exit_code);
  add_mask_report(app, exit_code);
  add_sensor_report(app, exit_code);
  add_stream_report(app, exit_code);
#endif
}
#else  // without FLOWDLO_BUILD_LAB
void add_reports(CLI::App& /*app*/, support::ExitCode& /*exit_code*/) {}
#endif

int run(int argc, char** argv) {
  CLI::App app{"Scenes with truth, and what is measured and fitted on them", called(argv[0])};
  app.set_version_flag("--version", "flowdlo " FLOWDLO_VERSION);
  app.require_subcommand(1);

  auto exit_code = support::ExitCode::kDone;
  add_synth_command(app, exit_code);
  add_eval_command(app, exit_code);
  add_reports(app, exit_code);
  support::add_shell_commands(app, exit_code);
  support::add_table_command(app);
  return support::run_command_line(app, argc, argv, exit_code);
}

}  // namespace
}  // namespace flowdlo::lab

int main(int argc, char** argv) { return flowdlo::lab::run(argc, argv); }
