// Ground: what a rope lies on, and what it says about the rope's depth.
//
// A depth camera that matches pictures sees through a window of several pixels. Where rope and
// ground are nearly as far away as each other the window holds both, and the rope comes out too
// deep, the thinner the more. Beside the rope, a window away, the ground is right. No rope lies
// deeper than what it lies on: its axis is at least a radius nearer.
#pragma once

#include <span>
#include <vector>

#include "prior/strip.hpp"

namespace flowdlo::prior {

/// [stations] by how much `axis_m` [stations], z of a rope's axis, is deeper than it can be where
/// the rope lies on its stations' ground; smooth along the rope. 0 where it is not, where no ground
/// is known, where what is beside the rope is nearer than the rope, and where it is so little that
/// the radius, which the mask tells, may be wrong by as much.
[[nodiscard]] std::vector<double> too_deep_m(const Strip& strip, std::span<const double> axis_m,
                                             float radius_m);

}  // namespace flowdlo::prior
