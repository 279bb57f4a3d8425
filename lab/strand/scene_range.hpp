// SceneRange: which `wide` scenes a report goes over with which field, and the going.
#pragma once

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "command/wide_scenes.hpp"
#include "field/network.hpp"
#include "reference/program.hpp"
#include "synth/synthetic_frame.hpp"
#include "threads/count.hpp"
#include "threads/team.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo::strand {

struct SceneRange : lab::WideScenes {
  SceneRange() { scenes = 300; }

  std::filesystem::path weights;
  int threads = 0;       ///< 0: one a core
  std::string scenario;  ///< of these scenes alone; empty: all
};

inline void add_options(CLI::App& app, SceneRange& range) {
  app.add_option("--field", range.weights, "Weights of the field, .safetensors")
      ->required()
      ->check(CLI::ExistingFile);
  lab::add_options(app, range);
  lab::add_threads_option(app, range.threads);
  app.add_option("--scenario", range.scenario, "Leave out the others, such as: coil");
}

/// The field's weights; null where they cannot be read, which is told on stderr.
[[nodiscard]] inline std::shared_ptr<const weights::FieldWeights> weights_of(
    const SceneRange& range) {
  auto loaded = weights::load_field(range.weights);
  if (loaded) return std::make_shared<const weights::FieldWeights>(*std::move(loaded));
  fmt::print(stderr, "{}\n", loaded.error().message);
  return nullptr;
}

/// A network on one thread of the CPU. Fails as Network::create does.
[[nodiscard]] inline Result<field::Network> one_network(
    const std::shared_ptr<const weights::FieldWeights>& weights) {
  return field::Network::create(weights, [] { return reference::create_program(1); });
}

/// Whether the scene is one of those that are asked for.
[[nodiscard]] inline bool wanted(const SceneRange& range, std::uint64_t index) {
  if (range.scenario.empty()) return true;
  const auto scenario =
      synth::scenario_of(synth::Split::kWide, *synth::part_of(range.part), 0, index);
  return scenario && *scenario == range.scenario;
}

/// What `measure(index, network)` makes of each scene, by index; scenes that fail are told on
/// stderr and left out. An Outcome has its scene's `index`.
template <class Outcome, class Measure>
std::vector<Outcome> over_scenes(const SceneRange& range,
                                 const std::shared_ptr<const weights::FieldWeights>& weights,
                                 const Measure& measure) {
  std::vector<Outcome> outcomes;
  std::mutex mutex;
  std::atomic<std::uint64_t> next = 0;
  threads::work_together(threads::count(range.threads), [&](int) {
    auto network = one_network(weights);
    for (std::uint64_t i = next++; i < range.scenes && network; i = next++) {
      if (!wanted(range, range.first + i)) continue;
      Result<Outcome> outcome = measure(range.first + i, *network);
      const std::lock_guard lock(mutex);
      if (outcome) {
        outcomes.push_back(*std::move(outcome));
      } else {
        fmt::print(stderr, "scene {}: {}\n", range.first + i, outcome.error().message);
      }
    }
  });
  std::sort(outcomes.begin(), outcomes.end(),
            [](const Outcome& a, const Outcome& b) { return a.index < b.index; });
  return outcomes;
}

}  // namespace flowdlo::strand
