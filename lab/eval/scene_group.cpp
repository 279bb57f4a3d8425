#include "eval/scene_group.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

namespace flowdlo::eval {

std::vector<DataSet> data_sets_of(std::span<const Trial> trials) {
  std::vector<DataSet> sets;
  for (const Trial& trial : trials) {
    auto found = std::find_if(sets.begin(), sets.end(),
                              [&](const DataSet& set) { return set.name == trial.data_set; });
    if (found == sets.end()) found = sets.insert(sets.end(), DataSet{trial.data_set, {}, true});
    found->trials.push_back(&trial);
    const bool thesis = trial.with_truth && thesis_row(trial.scene.scenario) != nullptr;
    found->thesis_groups = found->thesis_groups && (thesis || !trial.with_truth);
  }
  return sets;
}

std::vector<SceneGroup> groups_of(const DataSet& data_set) {
  std::map<std::string, std::vector<const Trial*>> scenarios;
  SceneGroup all{"all", {}, nullptr};
  for (const Trial* trial : data_set.trials) {
    if (!trial->with_truth) continue;
    scenarios[trial->scene.scenario].push_back(trial);
    all.trials.push_back(trial);
  }
  std::vector<SceneGroup> groups;
  if (all.trials.empty()) return groups;
  if (data_set.thesis_groups) {
    for (const ThesisRow& row : thesis_rows()) {
      const auto found = scenarios.find(row.scenario);
      if (found != scenarios.end()) groups.push_back({row.scenario, found->second, &row});
    }
    all.thesis = thesis_row("all");
  } else {
    for (auto& [name, members] : scenarios) groups.push_back({name, members, nullptr});
  }
  groups.push_back(std::move(all));
  return groups;
}

MeanError mean_error(const std::vector<const Trial*>& trials, const std::string& method) {
  MeanError mean;
  for (const Trial* trial : trials) {
    const Outcome* outcome = trial->of(method);
    if (outcome == nullptr) continue;
    mean.index_cm += 100 * outcome->index_m;
    mean.frechet_cm += 100 * outcome->frechet_m;
    ++mean.scenes;
  }
  if (mean.scenes > 0) {
    mean.index_cm /= mean.scenes;
    mean.frechet_cm /= mean.scenes;
  }
  return mean;
}

std::vector<const Trial*> having(const std::vector<const Trial*>& trials,
                                 const std::vector<std::string>& methods) {
  std::vector<const Trial*> kept;
  std::copy_if(trials.begin(), trials.end(), std::back_inserter(kept), [&](const Trial* trial) {
    return std::all_of(methods.begin(), methods.end(),
                       [&](const std::string& method) { return trial->of(method) != nullptr; });
  });
  return kept;
}

bool any_has(const std::vector<const Trial*>& trials, const std::string& method) {
  return std::any_of(trials.begin(), trials.end(),
                     [&](const Trial* trial) { return trial->of(method) != nullptr; });
}

std::string cell(const MeanError& error) {
  if (error.scenes == 0) return "-";
  return fmt::format("{:.3f} / {:.3f}", error.index_cm, error.frechet_cm);
}

std::string cell(const std::optional<ErrorPair>& error) {
  if (!error) return "-";
  return fmt::format("{:.3f} / {:.3f}", error->index_cm, error->frechet_cm);
}

}  // namespace flowdlo::eval
