// RopeDepth: the depth of the rope's axis along a strip, each depth read by the strand it is of.
#pragma once

#include <cstdint>
#include <vector>

#include "prior/ends.hpp"
#include "prior/strip.hpp"

namespace flowdlo::prior {

struct RopeDepth {
  std::vector<double> axis_m;      ///< [stations] z of the centerline
  std::vector<float> slant;        ///< [stations] 1 / sin of the angle between ray and rope
  std::vector<std::uint8_t> seen;  ///< [stations] 1 where depths back it
  float radius_m = 0;              ///< of the rope
  float noise_m = 0;               ///< typical misfit of a depth, over its station's slant
};

/// Empty `axis_m` when no station has a depth.
[[nodiscard]] RopeDepth measure_rope(const Strip& strip, const Extent& extent);

}  // namespace flowdlo::prior
