#include "gate_fit/gather.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "estimator/device_choice.hpp"
#include "field/network.hpp"
#include "flow/sampler.hpp"
#include "flowdlo/hints.hpp"
#include "flowdlo/weights.hpp"
#include "gate_fit/bare.hpp"
#include "gate_fit/sample_file.hpp"
#include "one_rope/two_ropes.hpp"
#include "progress_bar.hpp"
#include "reference/program.hpp"
#include "refine/network.hpp"
#include "survey/in_parallel.hpp"
#include "synth/synthetic_frame.hpp"
#include "threads/count.hpp"

namespace flowdlo::lab {
namespace {

constexpr std::uint64_t kLengthKnownEvery = 4;
constexpr std::uint64_t kApart = 500000;  // between scenes with and without the model
constexpr const char* kPairs = "pairs";   // a split of two drawn ropes in one mask
// A split of `wide` scenes, others than those with or without the model, with stereo cameras'
// depth as matching two pictures gives it.
constexpr const char* kMatched = "matched";
constexpr std::uint64_t kFirstMatched = kFirstUntrained + 2 * kApart;
constexpr const char* kRings =
    "rings";  // a split of the rings among scenes of several ropes, alone
constexpr std::uint64_t kFirstRing = kFirstUntrained + 3 * kApart;
// A split of `wide` scenes, others again, whose ropes are laid of strands and of any colours.
constexpr const char* kCords = "cords";
constexpr std::uint64_t kFirstCords = kFirstUntrained + 4 * kApart;
constexpr int kPixels = 1280 * 720;

/// Scenes of another kind, one on so many of the split.
struct Extra {
  const char* split;
  int on;
  bool bare;
  std::uint64_t first = 0;
};

constexpr std::array<Extra, 7> kExtras{{{"thesis", 4, false},
                                        {"drawn", 4, true},
                                        {"several", 8, true},
                                        {kPairs, 8, true},
                                        {kMatched, 3, false, kFirstMatched},
                                        {kCords, 3, true, kFirstCords},
                                        {kRings, 2, true, kFirstRing}}};

/// Scenes of one split and part, with or without the model.
struct Batch {
  SampleOrigin origin;
  int scenes = 0;
  std::string file;   ///< empty: keep nothing
  bool bare = false;  ///< some frames lack what some cameras do not give
};

/// What the estimator is told of a training frame, so that the fit learns what that is worth: of
/// every so many the rope's length, and of three in four rings that others part that it is one.
Hints known_of(const SampleOrigin& origin, std::uint64_t index, double length_m) {
  Hints known;
  if (origin.part != "training") return known;
  if (index % kLengthKnownEvery == 0) known.rope_length_m = length_m;
  if (origin.split == kRings && index % 2 == 1 && index % 8 != 7) known.closed = true;
  return known;
}

Result<flow::Sampler> sampler_of(const GatherConfig& config, const Model& model) {
  const auto back_end = estimator::cpu_back_end(config.threads);
  return flow::Sampler::create(
      model.weights, back_end.make_program,
      {.draws = config.draws,
       .steps = config.steps,
       .capacity = {
           .cloud_points = kPixels / 4, .field_texels = kPixels / 4, .image_pixels = kPixels}});
}

/// One thread's own.
struct Networks {
  std::optional<field::Network> field{};
  std::optional<refine::Network> refine{};
};

/// None without weights.
Result<Networks> networks_of(const Model& model, bool unrefined) {
  Networks networks;
  if (!model.field) return networks;
  const auto make_program = [] { return reference::create_program(1); };
  auto field = field::Network::create(model.field, make_program);
  if (!field) return field.error();
  networks.field = *std::move(field);
  if (unrefined || !model.field->refine) return networks;
  auto refine = refine::Network::create(*model.field->refine, make_program, model.field->tips);
  if (!refine) return refine.error();
  networks.refine = *std::move(refine);
  return networks;
}

using MaybeFrame = Result<std::optional<synth::SyntheticFrame>>;

/// Two drawn ropes in one mask, crossing, apart or touching; nothing where they find no room.
MaybeFrame pair_of(synth::Part part, std::uint64_t index, bool color) {
  auto first = synth::frame_at(synth::Split::kDrawn, part, 2 * index, {.color = color});
  if (!first) return first.error();
  const auto second = synth::frame_at(synth::Split::kDrawn, part, 2 * index + 1, {.color = color});
  if (!second) return second.error();
  constexpr auto kParted = static_cast<std::uint64_t>(Arrangement::kJoined);
  auto both =
      two_ropes(first->folder, second->folder, static_cast<Arrangement>(index % kParted), index);
  if (!both) return std::optional<synth::SyntheticFrame>();
  first->folder = *std::move(both);
  first->ropes.push_back(second->ropes.front());
  first->meta.index = index;
  return std::optional(*std::move(first));
}

/// A ring of a scene of several ropes, the only one in the mask; nothing of a scene without one. In
/// every second one the others are not there at all: where they are, they part it.
MaybeFrame ring_of(synth::Part part, std::uint64_t index, bool color) {
  const auto scenario = synth::scenario_of(synth::Split::kSeveral, part, /*seed=*/0, index);
  if (!scenario) return scenario.error();
  if (*scenario != "ropes-ring") return std::optional<synth::SyntheticFrame>();
  auto scene = synth::frame_at(synth::Split::kSeveral, part, index,
                               {.color = color, .ring_alone = index % 2 == 0});
  if (!scene) return scene.error();
  const auto ring = std::find_if(scene->ropes.begin(), scene->ropes.end(),
                                 [](const synth::TrueRope& rope) { return rope.closed; });
  if (ring == scene->ropes.end()) return std::optional<synth::SyntheticFrame>();
  const auto label = static_cast<std::uint16_t>(ring - scene->ropes.begin() + 1);
  for (std::size_t pixel = 0; pixel < scene->folder.mask.size(); ++pixel) {
    if (scene->folder.instances[pixel] != label) scene->folder.mask[pixel] = 0;
  }
  scene->folder.instances.clear();
  scene->folder.truth = ring->nodes;
  scene->ropes = {*ring};
  return std::optional(*std::move(scene));
}

MaybeFrame frame_of(const SampleOrigin& origin, std::uint64_t index, bool color) {
  const synth::Part part = *synth::part_of(origin.part);
  if (origin.split == kPairs) return pair_of(part, index, color);
  if (origin.split == kRings) return ring_of(part, index, color);
  const bool matched = origin.split == kMatched;
  const bool cords = origin.split == kCords;
  auto scene =
      synth::frame_at(matched || cords ? synth::Split::kWide : *synth::split_of(origin.split), part,
                      index, {.color = color, .matched = matched, .cords = cords});
  if (!scene) return scene.error();
  return std::optional(*std::move(scene));
}

using Measured = Result<std::optional<GateSample>>;

Measured measured_one(const GatherConfig& config, const Batch& batch, const Model& model,
                      flow::Sampler* sampler, Networks& networks, std::uint64_t number) {
  const std::uint64_t index = batch.origin.first + number;
  // Colours take longest, and nothing but the strand field asks for them.
  auto made = frame_of(batch.origin, index, networks.field.has_value());
  if (!made) return made.error();
  if (!*made) return std::optional<GateSample>();
  auto& scene = *made;
  if (batch.bare) lay_bare(scene->folder, index);
  const auto kind = model.weights->metadata.variant.prior_kind;
  const Hints known = known_of(batch.origin, index, scene->meta.length_m);
  return measure(*scene, sampler, networks.field ? &*networks.field : nullptr,
                 networks.refine ? &*networks.refine : nullptr,
                 model.fitted ? &*model.fitted : nullptr, config.draws, kind, known);
}

/// Scenes `done` and later; several at a time where there is no model, which takes threads itself.
Result<Samples> measured(const GatherConfig& config, const Batch& batch, int done) {
  const auto model = open_model(config);
  if (!model) return model.error();
  std::optional<flow::Sampler> sampler;
  if (batch.origin.draws > 0) {
    auto made = sampler_of(config, *model);
    if (!made) return made.error();
    sampler = *std::move(made);
  }
  support::ProgressBar bar(batch.origin.draws > 0 ? "scenes" : "scenes without model",
                           batch.scenes - done, config.quiet);
  const int threads = sampler ? 1 : threads::cores();
  Samples samples;
  for (auto& one : survey::in_parallel<std::optional<GateSample>>(
           {static_cast<std::uint64_t>(done), static_cast<std::uint64_t>(batch.scenes - done)},
           threads, [&] { return networks_of(*model, config.unrefined); },
           [&](Networks&networks, std::uint64_t number) {
             return measured_one(config, batch, *model, sampler ? &*sampler : nullptr, networks,
                                 number);
           },
           [&] { bar.advance(); })) {
    if (!one) return one.error();
    if (*one) samples.push_back(**std::move(one));
  }
  return samples;
}

/// From the file as far as it reaches, the rest anew.
Result<Samples> samples_of(const GatherConfig& config, const Batch& batch) {
  SampleFile kept;
  if (!batch.file.empty()) {
    auto read = read_samples(batch.file, batch.origin);
    if (!read) return read.error();
    kept = *std::move(read);
  }
  if (kept.scenes < batch.scenes) {
    auto more = measured(config, batch, kept.scenes);
    if (!more) return more.error();
    kept.samples.insert(kept.samples.end(), more->begin(), more->end());
    kept.scenes = batch.scenes;
    if (!batch.file.empty()) {
      auto written = write_samples(batch.file, batch.origin, kept);
      if (!written) return written.error();
    }
  }
  std::erase_if(kept.samples, [&](const GateSample& sample) {
    return sample.index >= batch.origin.first + static_cast<std::uint64_t>(batch.scenes);
  });
  return std::move(kept.samples);
}

std::string field_of(const GatherConfig& config) {
  if (config.field.empty()) return "";
  const auto weights = weights::load_field(config.field);
  if (!weights) return "";
  std::string field = weights->notes;
  if (weights->links) field += "; linked: " + weights->links->notes;
  if (weights->refine && !config.unrefined) {
    field += "; refined: " + weights->refine->notes;
    if (weights->tips) field += "; tips: " + weights->tips->notes;
  }
  return field;
}

}  // namespace

Result<Model> open_model(const GatherConfig& config) {
  auto loaded = weights::load(config.weights);
  if (!loaded) return loaded.error();
  Model model;
  model.weights = std::make_shared<const weights::Weights>(*std::move(loaded));
  if (!config.field.empty()) {
    auto field = weights::load_field(config.field);
    if (!field) return field.error();
    model.field = std::make_shared<const weights::FieldWeights>(*std::move(field));
  }
  model.fitted = gate::Fitted::of_weights(model.weights->calibration,
                                          model.field ? model.field->calibration : std::nullopt);
  return model;
}

Result<Samples> with_model(const GatherConfig& config, int scenes) {
  const auto info = inspect_weights(config.weights);
  if (!info) return info.error();
  return samples_of(config, {.origin = {.weights_sha256 = info->sha256,
                                        .field = field_of(config),
                                        .split = config.split,
                                        .part = config.part,
                                        .first = config.first,
                                        .draws = config.draws,
                                        .steps = config.steps},
                             .scenes = scenes,
                             .file = config.cache.empty() ? "" : config.cache + ".jsonl"});
}

Result<Samples> without_model(const GatherConfig& config, int scenes) {
  return samples_of(config, {.origin = {.weights_sha256 = "",
                                        .field = field_of(config),
                                        .split = config.split,
                                        .part = config.part,
                                        .first = config.first + kApart},
                             .scenes = scenes,
                             .file = config.cache.empty() ? "" : config.cache + "_priors.jsonl",
                             .bare = true});
}

Result<Samples> beside_split(const GatherConfig& config, int scenes) {
  Samples all;
  for (const Extra& extra : kExtras) {
    auto samples = samples_of(
        config,
        {.origin = {.weights_sha256 = "",
                    .field = field_of(config),
                    .split = extra.split,
                    .part = config.part},
         .scenes = scenes / extra.on,
         .file = config.cache.empty() ? "" : fmt::format("{}_{}.jsonl", config.cache, extra.split),
         .bare = extra.bare});
    if (!samples) return samples.error();
    all.insert(all.end(), samples->begin(), samples->end());
  }
  return all;
}

}  // namespace flowdlo::lab
