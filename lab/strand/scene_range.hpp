// SceneRange: which `wide` scenes a report goes over with which strand field, and the going.
#pragma once

#include <CLI/App.hpp>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "field/network.hpp"
#include "reference/program.hpp"
#include "survey/wide_scenes.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo::strand {

/// Every so many-th scene is held out of fits.
inline constexpr std::uint64_t kHeldOut = 4;

/// As a fit is to see the rendered scene of that index: four of seven have ropes with cords.
[[nodiscard]] inline synth::Render render_of(std::uint64_t index) {
  constexpr std::uint64_t kOf = 7;
  constexpr std::uint64_t kWithCords = 4;
  return {.cords = index % kOf < kWithCords};
}

struct SceneRange : survey::WideScenes {
  SceneRange() { scenes = 300; }

  std::filesystem::path weights;
  std::string scenario;  ///< of these scenes alone; empty: all
};

inline void add_options(CLI::App& app, SceneRange& range) {
  app.add_option("--field", range.weights, "Weights of the field, .safetensors")
      ->required()
      ->check(CLI::ExistingFile);
  survey::add_options(app, range);
  app.add_option("--scenario", range.scenario, "Leave out the others, such as: coil");
}

/// The field's network on one thread of the CPU. Fails as load_field and Network::create do.
[[nodiscard]] inline Result<field::Network> one_network(const std::filesystem::path& file) {
  auto loaded = weights::load_field(file);
  if (!loaded) return loaded.error();
  return field::Network::create(std::make_shared<const weights::FieldWeights>(*std::move(loaded)),
                                [] { return reference::create_program(1); });
}

/// Whether the scene is one of those that are asked for.
[[nodiscard]] inline bool wanted(const SceneRange& range, std::uint64_t index) {
  if (range.scenario.empty()) return true;
  const auto scenario =
      synth::scenario_of(synth::Split::kWide, *synth::part_of(range.part), 0, index);
  return scenario && *scenario == range.scenario;
}

/// What `measure(index, network)` makes of each scene, by index; scenes that fail are told on
/// stderr and left out.
template <class Outcome, class Measure>
std::vector<Outcome> over_scenes(const SceneRange& range, const Measure& measure) {
  const auto measure_wanted = [&](field::Network& network,
                                  std::uint64_t index) -> Result<std::optional<Outcome>> {
    if (!wanted(range, index)) return std::optional<Outcome>();
    Result<Outcome> outcome = measure(index, network);
    if (!outcome) return outcome.error();
    return std::optional<Outcome>(*std::move(outcome));
  };
  std::vector<Outcome> outcomes;
  for (auto& outcome : survey::over<std::optional<Outcome>>(
           range, [&] { return one_network(range.weights); }, measure_wanted)) {
    if (outcome) outcomes.push_back(*std::move(outcome));
  }
  return outcomes;
}

}  // namespace flowdlo::strand
