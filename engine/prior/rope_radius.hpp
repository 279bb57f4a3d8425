// RopeRadius: how thick the rope is, by the width of its mask and by the roundness of its depths,
// and which depths on its mask are those of what lies far behind it.
#pragma once

#include <span>
#include <vector>

#include "prior/ends.hpp"
#include "prior/strip.hpp"

namespace flowdlo::prior {

/// [stations] depth from which on a reading is none of the rope's. Where depth and mask do not lie
/// quite on each other, most of a thin rope's pixels may show the wall behind it, but nothing on
/// its mask is nearer than the rope: the nearest fifth around a station tells where the rope is.
[[nodiscard]] std::vector<float> background_m(const Strip& strip);

/// Half the mask's width in metres, over stations where the mask shows one whole strand. Needs a
/// reading. Deeper ones than `background_m` [stations] do not count.
[[nodiscard]] float mask_radius_m(const Strip& strip, const Extent& extent,
                                  std::span<const float> background_m);

/// `mask_radius_m`, or less where the mask bleeds onto what lies behind. On a round rope nothing x
/// beside the axis is more than x behind the ridge, and what lies behind the rope is a diameter
/// behind it: the radius is where the median of all readings at that distance falls away.
/// `axis_m` and `slant` are [stations]: a profile through the readings, and 1 / sin of the angle
/// between ray and rope.
[[nodiscard]] float depth_radius_m(const Strip& strip, const Extent& extent,
                                   std::span<const double> axis_m, std::span<const float> slant,
                                   float mask_radius_m);

}  // namespace flowdlo::prior
