// Results: chapter 4 of the thesis on the evaluated frames, as one Markdown page.
#pragma once

#include <span>
#include <string>

#include "eval/trial.hpp"

namespace flowdlo::eval {

/// A section a data set: Tables 4.2 to 4.7 as far as their methods were run, every baseline's
/// coverage, calibration, and the comparison with the thesis. `how` says how it was run; no
/// times, so that the same run gives the same page.
[[nodiscard]] std::string results_markdown(std::span<const Trial> trials, const std::string& how);

}  // namespace flowdlo::eval
