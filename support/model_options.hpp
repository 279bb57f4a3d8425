// Model options: the part of Config that every command which estimates takes from its arguments.
#pragma once

#include <CLI/App.hpp>

#include "flowdlo/config.hpp"

namespace flowdlo::support {

/// Adds --weights, --device, --steps, --draws, --seed, --threads, --budget, --prior, --gate,
/// --field, --field-weights and --rope-length. `config` holds the defaults, receives the values,
/// and must outlive the command's parsing.
void add_model_options(CLI::App& command, Config& config);

}  // namespace flowdlo::support
