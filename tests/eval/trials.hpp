// Trials made up for the tables.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "eval/trial.hpp"

namespace flowdlo::eval::test {

/// A trial whose methods have these index errors, cm.
inline Trial trial(std::string name, double prior, double refined, double model, double estimate) {
  Trial result;
  result.name = std::move(name);
  result.with_truth = true;
  result.draws = 4;
  result.accepted_draws = 3;
  result.source = Source::kPrediction;
  result.confidence = 0.9;
  const auto add = [&](const char* method, double cm) {
    result.methods[method] = {cm / 100, cm / 50, cm / 100, 0, 0};
  };
  add("prior", prior);
  add("refined", refined);
  add("model", model);
  add("estimate", estimate);
  add("oracle", std::min(refined, estimate));
  return result;
}

}  // namespace flowdlo::eval::test
