#include "eval/parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "eval/interval.hpp"
#include "eval/metrics.hpp"
#include "flowdlo/estimator.hpp"
#include "flowdlo/frame_folder.hpp"
#include "survey/table.hpp"
#include "survey/values.hpp"

namespace flowdlo::eval {
namespace {

constexpr double kCm = 100;

struct Setup {
  const char* name;
  FieldChoice field;
  Quality quality;
  int steps;
  int draws;
  GateChoice gate;
  bool first_prior;  ///< not the estimate, but the best prior of the first reading
};

constexpr auto kOfWeights = GateChoice::kOfWeights;
constexpr std::array<Setup, 9> kSetups{{
    {"mask alone, its first prior", FieldChoice::kOff, Quality::kFull, 1, 1, kOfWeights, true},
    {"mask alone, judged", FieldChoice::kOff, Quality::kFast, 1, 1, kOfWeights, false},
    {"strand field, its first prior", FieldChoice::kStrands, Quality::kFull, 1, 1, kOfWeights,
     true},
    {"strand field, judged", FieldChoice::kStrands, Quality::kFast, 1, 1, kOfWeights, false},
    {"and nodes and ends moved by networks: `fast`", FieldChoice::kBeside, Quality::kFast, 1, 1,
     kOfWeights, false},
    {"and the flow model, K = 1, D = 1", FieldChoice::kBeside, Quality::kFull, 1, 1, kOfWeights,
     false},
    {"K = 10, D = 1", FieldChoice::kBeside, Quality::kFull, 10, 1, kOfWeights, false},
    {"K = 10, D = 4: `full`", FieldChoice::kBeside, Quality::kFull, 10, 4, kOfWeights, false},
    {"the thesis' gate in place of the judge, K = 10, D = 4, no field", FieldChoice::kOff,
     Quality::kFull, 10, 4, GateChoice::kThesis, false},
}};

/// Distances of the nodes whose true places are off the mask.
std::vector<double> hidden_of(const Centerline& nodes, const Centerline& truth,
                              const Frame& frame) {
  std::vector<double> hidden;
  const Intrinsics& camera = frame.intrinsics;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const Point3& place = truth[i];
    const auto u = std::lround(camera.fx * place.x / place.z + camera.cx);
    const auto v = std::lround(camera.fy * place.y / place.z + camera.cy);
    const bool inside = u >= 0 && v >= 0 && u < frame.width && v < frame.height;
    if (inside && frame.mask[static_cast<std::size_t>(v * frame.width + u)] > 127) continue;
    hidden.push_back(std::hypot(static_cast<double>(nodes[i].x - place.x),
                                static_cast<double>(nodes[i].y - place.y),
                                static_cast<double>(nodes[i].z - place.z)));
  }
  return hidden;
}

Centerline first_prior(const Tensors& tensors) {
  Centerline nodes{};
  for (std::size_t i = 0; i < kNodes; ++i) {
    const float* const from = tensors.prior.data() + 3 * i;
    nodes[i] = {from[0], from[1], from[2]};
  }
  return nodes;
}

std::optional<PartOutcome> outcome_of(Estimator& estimator, const Setup& setup,
                                      const FrameFolder& folder) {
  Tensors tensors;
  const Frame frame = folder.frame();
  const auto estimate =
      setup.first_prior ? estimator.estimate(frame, tensors) : estimator.estimate(frame);
  if (!estimate) return std::nullopt;
  const Centerline nodes = setup.first_prior ? first_prior(tensors) : estimate->nodes;
  const Score scored = score(nodes, *folder.truth);
  return PartOutcome{scored.index_m, hidden_of(nodes, turned(*folder.truth, scored), frame),
                     !setup.first_prior && estimate->origin == Origin::kDraw,
                     estimate->timings.total_ms};
}

/// Only frames of which every part made something can be compared.
void keep_common(Parts& parts, const std::vector<std::vector<std::optional<PartOutcome>>>& all) {
  std::vector<SceneInfo> scenes;
  for (std::size_t i = 0; i < parts.scenes.size(); ++i) {
    const bool common = std::all_of(all.begin(), all.end(),
                                    [&](const auto& outcomes) { return outcomes[i].has_value(); });
    if (!common) continue;
    scenes.push_back(parts.scenes[i]);
    for (std::size_t p = 0; p < all.size(); ++p) parts.parts[p].outcomes.push_back(*all[p][i]);
  }
  parts.scenes = std::move(scenes);
}

struct Group {
  const char* name;
  bool (*has)(const SceneInfo&);
};

constexpr std::array<Group, 7> kGroups{{
    {"all", [](const SceneInfo&) { return true; }},
    {"easy", [](const SceneInfo& scene) { return scene.easy(); }},
    {"gap over 3 widths", [](const SceneInfo& scene) { return scene.gap_widths > 3; }},
    {"over 6", [](const SceneInfo& scene) { return scene.gap_widths > 6; }},
    {"over 12", [](const SceneInfo& scene) { return scene.gap_widths > 12; }},
    {"an end hidden", [](const SceneInfo& scene) { return scene.has("hidden_end"); }},
    {"ambiguous: coils, strands that touch",
     [](const SceneInfo& scene) { return scene.has("coil") || scene.has("touch"); }},
}};

std::vector<double> errors_of(const Part& part, const std::vector<SceneInfo>& scenes,
                              const Group& group) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    if (group.has(scenes[i])) errors.push_back(kCm * part.outcomes[i].index_m);
  }
  return errors;
}

}  // namespace

std::size_t count_of_parts() { return kSetups.size(); }

Result<Parts> measure_parts(const Config& config, std::span<const std::filesystem::path> frames,
                            const std::function<void()>& advance) {
  Parts parts;
  std::vector<std::filesystem::path> described;
  for (const auto& frame : frames) {
    const auto scene = read_scene_info(frame);
    if (!scene) continue;
    described.push_back(frame);
    parts.scenes.push_back(*scene);
  }
  std::vector<std::vector<std::optional<PartOutcome>>> all;
  for (const Setup& setup : kSetups) {
    Config one = config;
    one.field = setup.field;
    one.quality = setup.quality;
    one.euler_steps = setup.steps;
    one.draws = setup.draws;
    one.gate = setup.gate;
    auto estimator = Estimator::create(one);
    if (!estimator) return estimator.error();
    parts.parts.push_back({setup.name});
    auto& outcomes = all.emplace_back();
    for (const auto& frame : described) {
      const auto folder = load_frame_folder(frame);
      const bool usable = folder && folder->truth;
      outcomes.push_back(usable ? outcome_of(*estimator, setup, *folder) : std::nullopt);
      advance();
    }
  }
  keep_common(parts, all);
  return parts;
}

std::string parts_markdown(const Parts& parts) {
  std::vector<std::string> header{"parts"};
  for (const Group& group : kGroups) {
    const auto scenes = std::count_if(parts.scenes.begin(), parts.scenes.end(), group.has);
    header.push_back(fmt::format("{} ({})", group.name, scenes));
  }
  for (const char* column : {"hidden nodes, cm", "draws of the model", "ms, median"}) {
    header.emplace_back(column);
  }
  survey::Table table(header);
  const Part& whole = parts.parts[kDefaultPart];
  for (const Part& part : parts.parts) {
    std::vector<std::string> cells{part.name};
    for (const Group& group : kGroups) {
      const auto errors = errors_of(part, parts.scenes, group);
      std::string cell =
          errors.empty() ? "-" : fmt::format("{:.3f}", survey::Values(errors).mean());
      if (&group == kGroups.data() && &part != &whole) {
        const Interval ratio = ratio_interval(errors, errors_of(whole, parts.scenes, group));
        cell += fmt::format(" ({:.2f} [{:.2f}, {:.2f}])", ratio.value, ratio.low, ratio.high);
      }
      cells.push_back(std::move(cell));
    }
    survey::Values hidden_cm;
    survey::Values ms;
    int draws = 0;
    for (const PartOutcome& outcome : part.outcomes) {
      for (const double m : outcome.hidden_m) hidden_cm.add(kCm * m);
      ms.add(outcome.total_ms);
      draws += outcome.draw ? 1 : 0;
    }
    cells.push_back(fmt::format("{:.3f}", hidden_cm.mean()));
    cells.push_back(fmt::format("{} of {}", draws, part.outcomes.size()));
    cells.push_back(fmt::format("{:.1f}", ms.median()));
    table.add(std::move(cells));
  }
  return fmt::format(
      "## What each part adds\n\nMean index error (Eq. 4.1) over {} frames, cm; less is better. In "
      "brackets its ratio to that of `fast` with the 95 % bootstrap interval, in pairs. Hidden "
      "nodes: those whose true place is off the mask, their mean distance from it.\n\n{}",
      parts.scenes.size(), table.text());
}

}  // namespace flowdlo::eval
