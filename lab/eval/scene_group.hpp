// SceneGroup: trials of one scenario, and means over them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "eval/thesis_figures.hpp"
#include "eval/trial.hpp"

namespace flowdlo::eval {

struct SceneGroup {
  std::string name;  ///< a scenario, or "all"
  std::vector<const Trial*> trials;
  const ThesisRow* thesis = nullptr;  ///< where the data set has the thesis' groups
};

/// One data set: the frames of one folder.
struct DataSet {
  std::string name;
  std::vector<const Trial*> trials;
  bool thesis_groups = false;  ///< its scenarios are the thesis' nine
};

/// In order of first appearance. Trials must outlive the result.
[[nodiscard]] std::vector<DataSet> data_sets_of(std::span<const Trial> trials);

/// Those with truth by scenario, in the thesis' order or by name; "all" comes last.
[[nodiscard]] std::vector<SceneGroup> groups_of(const DataSet& data_set);

/// Mean errors of `method` over those of `trials` that have it, and how many those are.
struct MeanError {
  double index_cm = 0;
  double frechet_cm = 0;
  int scenes = 0;
};
[[nodiscard]] MeanError mean_error(const std::vector<const Trial*>& trials,
                                   const std::string& method);

/// Those of `trials` that have every one of `methods`.
[[nodiscard]] std::vector<const Trial*> having(const std::vector<const Trial*>& trials,
                                               const std::vector<std::string>& methods);

/// True where some trial has the method.
[[nodiscard]] bool any_has(const std::vector<const Trial*>& trials, const std::string& method);

/// "1.234 / 2.345", index error and Frechet distance in cm; "-" where there is nothing.
[[nodiscard]] std::string cell(const MeanError& error);
[[nodiscard]] std::string cell(const std::optional<ErrorPair>& error);

}  // namespace flowdlo::eval
