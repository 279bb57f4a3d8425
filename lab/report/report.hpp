// Report: tables, figures and a 3D view of every scene as one page that needs nothing else.
#pragma once

#include <span>
#include <string>

#include "eval/figures.hpp"
#include "eval/trial.hpp"

namespace flowdlo::report {

/// `results` is results.md. The page opens from disk, without a network.
[[nodiscard]] std::string report_html(std::span<const eval::Trial> trials,
                                      const std::string& results,
                                      std::span<const eval::Figure> figures);

}  // namespace flowdlo::report
