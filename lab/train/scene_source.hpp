// SceneSource: scenes by number, from whichever maker the recipe names.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "flowdlo/result.hpp"
#include "train/record.hpp"

namespace flowdlo::train {

enum class Part { kTraining, kValidation };

/// "training" or "validation".
[[nodiscard]] const char* name_of(Part part);

struct SourceConfig {
  std::string maker = "wide";  ///< "wide", "thesis": lab/synth's splits; "sketch": lab/scene
  std::uint64_t seed = 0;
  int frames_per_scene = 1;  ///< of the thesis split's static scenes
  double depth_dropout = 0;  ///< share of training frames that lose stretches of depth
};

/// A labelled frame that owns its pixels.
struct OwnedFrame {
  std::shared_ptr<const void> pixels;
  LabelledFrame labelled;
};

/// Scene `index` of a part: the same on every call and thread, and never in both parts.
using SceneSource = std::function<Result<OwnedFrame>(Part part, std::uint64_t index)>;

/// Fails with kBadInput when the maker is unknown or was not built.
[[nodiscard]] Result<SceneSource> scene_source(const SourceConfig& config);

/// How many scenes a part has; 0: no end.
[[nodiscard]] std::uint64_t scene_count(const SourceConfig& config, Part part);

/// One line that names everything a record depends on, beside its options.
[[nodiscard]] std::string describe(const SourceConfig& config);

}  // namespace flowdlo::train
