// The subcommands of flowdlo-train. Exit codes: 0 done, 1 failed, 2 wrong usage.
#pragma once

#include <CLI/CLI.hpp>

#include "survey/failed.hpp"

namespace flowdlo::train {

using survey::failed;

void add_records_command(CLI::App& app, int& exit_code);
/// `argc` and `argv` become the training command in the weights' metadata.
void add_train_command(CLI::App& app, int argc, char** argv, int& exit_code);
void add_resume_command(CLI::App& app, int argc, char** argv, int& exit_code);
void add_export_command(CLI::App& app, int& exit_code);
void add_golden_command(CLI::App& app, int& exit_code);
/// Where the scene maker is part of the build.
void add_field_commands(CLI::App& app, int argc, char** argv, int& exit_code);
void add_refine_command(CLI::App& app, int argc, char** argv, int& exit_code);
void add_curves_command(CLI::App& app, int& exit_code);

}  // namespace flowdlo::train
