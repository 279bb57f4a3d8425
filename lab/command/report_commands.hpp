// The commands of flowdlo-lab beside synth and eval: each adds itself to the program, and when it
// runs it sets `exit_code`. docs/evaluation.md says what they are for.
#pragma once

#include <CLI/App.hpp>

#include "exit_code.hpp"

namespace flowdlo::lab {

void add_scenes(CLI::App& program, support::ExitCode& exit_code);
void add_make_scene(CLI::App& program, support::ExitCode& exit_code);
void add_curve_report(CLI::App& program, support::ExitCode& exit_code);
void add_hostile_report(CLI::App& program, support::ExitCode& exit_code);
void add_one_rope_report(CLI::App& program, support::ExitCode& exit_code);
void add_mask_report(CLI::App& program, support::ExitCode& exit_code);
void add_ropes_report(CLI::App& program, support::ExitCode& exit_code);
void add_sensor_report(CLI::App& program, support::ExitCode& exit_code);
void add_stream_report(CLI::App& program, support::ExitCode& exit_code);
void add_field_report(CLI::App& program, support::ExitCode& exit_code);
void add_reading_report(CLI::App& program, support::ExitCode& exit_code);
void add_energy_fit(CLI::App& program, support::ExitCode& exit_code);
void add_link_fit(CLI::App& program, support::ExitCode& exit_code);
void add_tip_fit(CLI::App& program, support::ExitCode& exit_code);
void add_gate_fit(CLI::App& program, support::ExitCode& exit_code);

}  // namespace flowdlo::lab
