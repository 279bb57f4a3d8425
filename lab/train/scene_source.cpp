#include "train/scene_source.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>
#include <vector>

#include "random/philox.hpp"
#include "scene/scene.hpp"
#include "train/depth_dropout.hpp"
#ifdef FLOWDLO_WITH_SYNTH
#include "synth/synthetic_frame.hpp"
#endif

namespace flowdlo::train {
namespace {

constexpr std::uint64_t kDropoutStream = 0xD20A;
constexpr std::uint64_t kDistinctScene = 0x9E3779B97F4A7C15ULL;

/// Whether this scene loses depth; validation frames stay as they are.
bool drops_depth(const SourceConfig& config, Part part, std::uint64_t index) {
  if (part == Part::kValidation) return false;
  const auto word = random::philox(config.seed, index, kDropoutStream)[0];
  return random::uniform(word) < config.depth_dropout;
}

/// Puts a holed depth image in place of the frame's own; `frame.pixels` keeps both alive.
OwnedFrame with_dropout(OwnedFrame frame, std::uint64_t seed) {
  auto depth = std::make_shared<std::vector<float>>(
      with_depth_dropout(frame.labelled.frame, frame.labelled.truth, seed));
  frame.labelled.frame.depth_m = *depth;
  frame.pixels =
      std::make_shared<const std::pair<std::shared_ptr<const void>, std::shared_ptr<const void>>>(
          frame.pixels, depth);
  return frame;
}

Difficulty difficulty_of(lab::Kind kind) {
  switch (kind) {
    case lab::Kind::kSimple:
    case lab::Kind::kHanging:
      return Difficulty::kEasy;
    case lab::Kind::kOccluder:
    case lab::Kind::kBadDepth:
    case lab::Kind::kTouching:
    case lab::Kind::kCoil:
      return Difficulty::kHard;
    default:
      return Difficulty::kMiddle;
  }
}

OwnedFrame sketched(const SourceConfig& config, Part part, std::uint64_t index) {
  const auto kind = static_cast<lab::Kind>(index % lab::kKinds);
  const std::uint64_t number = (index / lab::kKinds) * 2 + (part == Part::kValidation ? 1 : 0);
  auto scene =
      std::make_shared<lab::Scene>(lab::make_scene(kind, config.seed * kDistinctScene + number));
  OwnedFrame owned;
  owned.labelled = {.frame = scene->frame(),
                    .truth = scene->truth,
                    .scenario = std::string(lab::name_of(kind)),
                    .difficulty = difficulty_of(kind),
                    .intersection = kind == lab::Kind::kOneCrossing ||
                                    kind == lab::Kind::kManyCrossings ||
                                    kind == lab::Kind::kHangingLoops,
                    .index = index};
  owned.pixels = std::move(scene);
  return owned;
}

#ifdef FLOWDLO_WITH_SYNTH
Result<OwnedFrame> synthetic(const SourceConfig& config, synth::Split split, Part part,
                             std::uint64_t index) {
  const auto frames = static_cast<std::uint64_t>(config.frames_per_scene);
  auto made = synth::make_frame(
      split, part == Part::kTraining ? synth::Part::kTraining : synth::Part::kValidation,
      config.seed, index / frames, {.color = false, .frame = static_cast<int>(index % frames)});
  if (!made) return made.error();
  auto scene = std::make_shared<synth::SyntheticFrame>(*std::move(made));
  const auto& meta = scene->meta;
  const Difficulty difficulty = meta.easy()   ? Difficulty::kEasy
                                : meta.hard() ? Difficulty::kHard
                                              : Difficulty::kMiddle;
  OwnedFrame owned;
  owned.labelled = {.frame = scene->frame(),
                    .truth = scene->truth(),
                    .scenario = meta.scenario,
                    .difficulty = difficulty,
                    .intersection = meta.intersection,
                    .index = index};
  owned.pixels = std::move(scene);
  return owned;
}
#endif

Result<OwnedFrame> frame_of(const SourceConfig& config, Part part, std::uint64_t index) {
#ifdef FLOWDLO_WITH_SYNTH
  if (const auto split = synth::split_of(config.maker)) {
    return synthetic(config, *split, part, index);
  }
#endif
  return sketched(config, part, index);
}

}  // namespace

const char* name_of(Part part) { return part == Part::kTraining ? "training" : "validation"; }

Result<SceneSource> scene_source(const SourceConfig& config) {
  const bool synthetic = config.maker == "wide" || config.maker == "thesis";
#ifndef FLOWDLO_WITH_SYNTH
  if (synthetic) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("data.maker: \"{}\" needs Embree, which this build lacks; install "
                             "libembree-dev and build again",
                             config.maker)};
  }
#endif
  if (!synthetic && config.maker != "sketch") {
    return Error{
        ErrorCode::kBadInput,
        fmt::format("data.maker: expected wide, thesis or sketch, got \"{}\"", config.maker)};
  }
  return SceneSource([config](Part part, std::uint64_t index) -> Result<OwnedFrame> {
    auto frame = frame_of(config, part, index);
    if (frame && drops_depth(config, part, index)) {
      return with_dropout(*std::move(frame), config.seed ^ (index + 1) * kDistinctScene);
    }
    return frame;
  });
}

std::uint64_t scene_count(const SourceConfig& config, Part part) {
#ifdef FLOWDLO_WITH_SYNTH
  if (const auto split = synth::split_of(config.maker)) {
    return synth::scene_count(*split, part == Part::kTraining ? synth::Part::kTraining
                                                              : synth::Part::kValidation) *
           static_cast<std::uint64_t>(config.frames_per_scene);
  }
#endif
  static_cast<void>(config);
  static_cast<void>(part);
  return 0;
}

std::string describe(const SourceConfig& config) {
  return fmt::format("{} seed {} frames-per-scene {} depth-dropout {}", config.maker, config.seed,
                     config.frames_per_scene, config.depth_dropout);
}

}  // namespace flowdlo::train
