// DrawnFrame: scenes of lab/scene as synthetic frames.
#pragma once

#include <cstdint>

#include "scene/ropes.hpp"
#include "scene/scene.hpp"
#include "synth/synthetic_frame.hpp"

namespace flowdlo::synth {

/// Seeds below it are the training part's, the others the validation's.
inline constexpr std::uint64_t kFirstDrawnValidation = 900000;

/// Scene `index` of a part is of kind index % kKinds; this is its seed. `seed` is the split's.
[[nodiscard]] std::uint64_t drawn_seed(Part part, std::uint64_t seed, std::uint64_t index);

/// The scene as a frame, with dense truth where that is asked for. Of its meta, defects are those
/// of its kind, and split, part, index and frame are not set.
[[nodiscard]] SyntheticFrame drawn_frame(lab::Kind kind, std::uint64_t seed, bool dense = false);

/// A scene of several ropes likewise; of its meta, the number of ropes alone is set.
[[nodiscard]] SyntheticFrame drawn_ropes_frame(lab::RopesKind kind, int ropes, std::uint64_t seed,
                                               bool dense = false);

}  // namespace flowdlo::synth
