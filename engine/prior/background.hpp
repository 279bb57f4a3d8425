// Background: depths on the rope's mask that are those of what lies far behind it.
#pragma once

#include <vector>

#include "prior/strip.hpp"

namespace flowdlo::prior {

/// [stations] depth from which on a reading is none of the rope's. Where depth and mask do not lie
/// quite on each other, most of a thin rope's pixels may show the wall behind it, but nothing on
/// its mask is nearer than the rope: the nearest fifth around a station tells where the rope is.
[[nodiscard]] std::vector<float> background_m(const Strip& strip);

}  // namespace flowdlo::prior
