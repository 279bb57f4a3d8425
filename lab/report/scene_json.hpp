// SceneJson: the curves of every trial as the viewer of report.html reads them.
#pragma once

#include <span>
#include <string>

#include "eval/trial.hpp"

namespace flowdlo::report {

/// Trials without a curve are left out. A small picture of each frame is read from its folder; a
/// frame that has gone has none. Safe inside a script element.
[[nodiscard]] std::string scenes_json(std::span<const eval::Trial> trials);

}  // namespace flowdlo::report
