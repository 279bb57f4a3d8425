// Trials with accounts and curves, made up for the chapter's tables and figures.
#pragma once

#include <cmath>
#include <string>

#include "eval/trials.hpp"

namespace flowdlo::eval::test {

inline Centerline wave(double shift_m) {
  Centerline nodes{};
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double t = static_cast<double>(i) / (kNodes - 1);
    nodes[i] = {static_cast<float>(0.3 * t), static_cast<float>(0.05 * std::sin(9 * t) + shift_m),
                0.5F};
  }
  return nodes;
}

/// A scene of the thesis' groups with every contender; errors in cm are 4, 1, 2 and 0.5 of prior,
/// refined prior, model and estimate, 3 of the full model, 6 of TrackDLO-init.
inline Trial scene(const std::string& name, const std::string& scenario) {
  Trial result = trial(name, 4, 1, 2, 0.5);
  result.data_set = "set";
  result.scene.scenario = scenario;
  result.truth = wave(0);
  result.nodes = wave(0.005);
  const auto add = [&](const std::string& method, double cm, int draws, int accepted) {
    result.methods[method] = {cm / 100, cm / 50, cm / 100, 0, 0};
    result.accounts[method] = {"", true, draws, accepted, 0.75};
    result.curves[method] = {wave(cm / 100)};
  };
  for (const char* model : {"full", "no-points", "direct", "residual"}) add(model, 3, 4, 2);
  for (const char* sweep : {"full@1", "full@4", "full@10", "full@20", "direct@1", "direct@4",
                            "direct@10", "direct@20"}) {
    add(sweep, 3, 4, 2);
  }
  add("full.prior", 4, 1, 0);
  result.methods["full.hybrid"] = result.methods["full.oracle"] = {0.02, 0.04, 0.02, 0, 0};
  result.methods["hybrid"] = {0.015, 0.03, 0.015, 0, 0};
  add("trackdlo", 6, 1, 0);
  result.accounts["estimate"] = {"", true, 1, 0, 1};
  result.accounts["model"] = {"", true, 4, 3, 0.9};
  result.accounts["prior"] = {"", true, 1, 0, 0.95};
  return result;
}

/// The same where TrackDLO-init gives nothing.
inline Trial scene_without_baseline(const std::string& name, const std::string& scenario) {
  Trial result = scene(name, scenario);
  result.methods.erase("trackdlo");
  result.curves.erase("trackdlo");
  result.accounts["trackdlo"] = {"cost of two tips is not a number", false, 1, 0, 0};
  return result;
}

/// A frame without truth.
inline Trial real_frame(const std::string& name) {
  Trial result = scene(name, "unknown");
  result.with_truth = false;
  result.methods.clear();
  return result;
}

}  // namespace flowdlo::eval::test
