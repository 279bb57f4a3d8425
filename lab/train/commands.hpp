// The subcommands of flowdlo-train. Exit codes: 0 done, 1 failed, 2 wrong usage.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "flowdlo/result.hpp"

namespace flowdlo::train {

/// Tells why on stderr; `code` is the exit code.
inline int failed(const Error& error, int code = 1) {
  fmt::print(stderr, "{}\n", error.message);
  return code;
}

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
