// GroundDepth: how far away a rope is that shows no depth of its own.
//
// A dark or thin cable gives many cameras nothing back, while they see all that is beside it. Such
// a rope is taken to lie on what is beside it. It may as well hang in front of that: nobody can
// know, and whoever asks here says so to the caller.
#pragma once

#include <optional>
#include <vector>

#include "flowdlo/frame.hpp"

namespace flowdlo::evidence {

/// A mask that has a depth at fewer of its pixels than this share of them shows none: what few
/// pixels have is as often what flies at the rope's edges.
inline constexpr float kLeastMeasured = 0.01F;

/// [height, width] metres: the frame's depth, and where the mask has none that of a rope that lies
/// on the plane through what is beside it. Nothing where the rope shows depth, or where no plane is
/// seen. Expects a valid frame.
[[nodiscard]] std::optional<std::vector<float>> ground_depth(const Frame& frame);

}  // namespace flowdlo::evidence
