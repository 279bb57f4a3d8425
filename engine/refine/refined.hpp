// Refined: a hypothesis with its nodes where the refining network sees the rope's axis.
#pragma once

#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "refine/network.hpp"

namespace flowdlo::refine {

/// A node is moved no farther than this, deep and aside, radii.
inline constexpr float kMostOffset = 2;

/// The curve's nodes, each moved deep and aside but never along the rope; as they are where the
/// curve makes no strip, or where a moved one would not be finite and in front of the camera. Fails
/// as Network::see does.
[[nodiscard]] Result<Centerline> refined(const Curve& curve, const Frame& frame, Network& network);

}  // namespace flowdlo::refine
