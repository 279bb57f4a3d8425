// WideScenes: which rendered scenes of the split `wide` a report goes over, and the going.
#pragma once

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "flowdlo/estimator.hpp"
#include "survey/failed.hpp"
#include "survey/in_parallel.hpp"
#include "synth/synthetic_frame.hpp"

namespace flowdlo::survey {

struct WideScenes {
  std::string part = "validation";  ///< or "training"
  std::uint64_t first = 0;          ///< index of the first scene
  std::uint64_t scenes = 100;
  int threads = 0;  ///< scenes at a time; 0: one a core

  [[nodiscard]] Result<synth::SyntheticFrame> make(std::uint64_t index,
                                                   const synth::Render& render = {},
                                                   synth::Split split = synth::Split::kWide) const {
    return synth::make_frame(split, *synth::part_of(part), 0, index, render);
  }
};

/// --part, --first, --scenes and --threads; what `scenes` holds is what they are where they are not
/// given.
inline void add_options(CLI::App& app, WideScenes& scenes) {
  app.add_option("--part", scenes.part, "Of the wide split: training or validation")
      ->check(CLI::IsMember({"training", "validation"}))
      ->capture_default_str();
  app.add_option("--first", scenes.first, "Index of the first scene")->capture_default_str();
  app.add_option("--scenes", scenes.scenes, "How many")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  app.add_option("--threads", scenes.threads, "Scenes at a time; 0: one a core")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
}

/// As in_parallel; scenes that fail are told on stderr and left out.
template <class Outcome, class MakeTool, class Work>
std::vector<Outcome> over(const WideScenes& scenes, const MakeTool& make_tool, const Work& work) {
  std::vector<Outcome> outcomes;
  std::uint64_t index = scenes.first;
  for (auto& outcome :
       in_parallel<Outcome>({scenes.first, scenes.scenes}, scenes.threads, make_tool, work)) {
    if (outcome) {
      outcomes.push_back(*std::move(outcome));
    } else {
      fmt::print(stderr, "scene {}: {}\n", index, outcome.error().message);
    }
    ++index;
  }
  return outcomes;
}

/// An estimator on one thread of the CPU, as reports use them. `weights` empty: those that ship.
inline Result<Estimator> one_estimator(const std::string& weights, Quality quality = Quality::kFast,
                                       int ropes = 1) {
  Config config;
  config.weights = weights;
  config.device = "cpu";
  config.quality = quality;
  config.threads = 1;
  config.ropes = ropes;
  config.max_width = 1920;
  config.max_height = 1080;
  return Estimator::create(config);
}

}  // namespace flowdlo::survey
