// Eval outputs: chapter 4 of the thesis from evaluated rows: results.md, figures, report.html.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>

#include "eval/contenders.hpp"
#include "eval/merged_rows.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::lab {

/// Adds --baselines and --models. `contenders` must outlive the command's parsing.
void add_contender_options(CLI::App& command, eval::ContenderConfig& contenders);

/// Adds --results. `file` must outlive the command's parsing.
void add_results_option(CLI::App& command, std::filesystem::path& file);

/// Writes results.md, methods.csv, figures/NAME.png and report.html to `out`, and results.md to
/// `results`, too, unless that is empty. Fails with kIo; `out` must exist.
[[nodiscard]] Result<void> save_chapter(const std::filesystem::path& out,
                                        const std::filesystem::path& results,
                                        const eval::MergedRows& merged);

}  // namespace flowdlo::lab
