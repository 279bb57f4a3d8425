// Tables: trials as Markdown and CSV.
#pragma once

#include <span>
#include <string>

#include "eval/trial.hpp"

namespace flowdlo::eval {

/// A row a frame; errors in cm, empty where a method gave nothing. No times: they differ from run
/// to run, and the rows of a run in parts have to be those of a run in one.
[[nodiscard]] std::string rows_csv(std::span<const Trial> trials);

/// Milliseconds a frame, for those with an estimate.
[[nodiscard]] std::string timings_csv(std::span<const Trial> trials);

/// The same as one line for a reader; empty without an estimate.
[[nodiscard]] std::string timing_sentence(std::span<const Trial> trials);

/// Errors by scenario and by difficulty, each method against the refined prior with bootstrap
/// intervals, how far the estimate's confidence can be trusted, calibration, coverage. Ends with
/// the note that the scenes are not the thesis'.
[[nodiscard]] std::string tables_markdown(std::span<const Trial> trials);

}  // namespace flowdlo::eval
