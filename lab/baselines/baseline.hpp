// Baseline: the published ways from a frame to 64 nodes, each by its name.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "baselines/attempt.hpp"
#include "baselines/observation.hpp"

namespace flowdlo::baselines {

struct Baseline {
  const char* name;   ///< as on the command line
  const char* title;  ///< as in the tables
  /// Direction is arbitrary: score by Eq. (4.3). Otherwise canonical, as the thesis' own.
  bool either_way;
  Attempt (*run)(const Observation& observation);
};

/// trackdlo, trackdlo-repaired, geodesic (Eq. 3.1-3.7), mbest and dloftbs (refined prior).
[[nodiscard]] std::span<const Baseline> all_baselines();

/// By name; nullptr: there is none of that name.
[[nodiscard]] const Baseline* find_baseline(const std::string& name);

/// `names` as given on the command line; "all" stands for every one. "prior" names what every
/// table holds anyway, "trackdlo-init" is trackdlo. Fails with kBadInput, listing the names.
[[nodiscard]] Result<std::vector<const Baseline*>> choose_baselines(
    const std::vector<std::string>& names);

}  // namespace flowdlo::baselines
