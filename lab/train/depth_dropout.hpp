// DepthDropout: stretches of rope whose depth a sensor would not return.
//
// The hole is made in the frame, before the engine looks at it: prior, support and visible points
// of such a record are what the engine really makes of a frame like that, and the truth stays true.
#pragma once

#include <cstdint>
#include <vector>

#include "flowdlo/centerline.hpp"
#include "flowdlo/frame.hpp"

namespace flowdlo::train {

/// `frame`'s depth with one to three stretches, together up to 40 % of the rope, set to zero.
/// Depends on `seed` and the arguments alone.
[[nodiscard]] std::vector<float> with_depth_dropout(const Frame& frame, const Centerline& truth,
                                                    std::uint64_t seed);

}  // namespace flowdlo::train
