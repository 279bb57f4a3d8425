// A trial whose curves are worth looking at.
#pragma once

#include <cmath>
#include <string>
#include <utility>

#include "eval/trial.hpp"

namespace flowdlo::report::test {

inline Centerline curl(double lift_m) {
  Centerline nodes{};
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double t = 0.12 * static_cast<double>(i);
    const double radius_m = 0.03 + 0.002 * static_cast<double>(i);
    nodes[i] = {static_cast<float>(radius_m * std::cos(t)),
                static_cast<float>(radius_m * std::sin(t)), static_cast<float>(0.5 + lift_m)};
  }
  return nodes;
}

inline eval::Trial curled_trial(std::string name) {
  eval::Trial trial;
  trial.name = std::move(name);
  trial.data_set = "curls";
  trial.with_truth = true;
  trial.truth = curl(0);
  trial.nodes = curl(0.004);
  trial.draws = 2;
  trial.curves["model"] = {curl(0.01), curl(-0.01)};
  trial.methods["estimate"] = {0.004, 0.004, 0.004, 0, 0};
  return trial;
}

}  // namespace flowdlo::report::test
