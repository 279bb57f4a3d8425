// The estimator's ranking and confidence: fitted to scenes with truth, and judged on others.
#pragma once

#include <CLI/App.hpp>

namespace flowdlo::lab {

/// Adds the subcommands `fit` and `confidence` to `scenes`.
void add_confidence(CLI::App& scenes);

}  // namespace flowdlo::lab
