// HangingRope: a rope in free air, held by two grippers or by one.
#pragma once

#include "synth/flat_shape.hpp"

namespace flowdlo::synth {

struct Hanging {
  bool two_grippers = true;
  int loops = 0;
  double swing_m = 0.05;  ///< how far it leaves its plane
};

/// x to the right, y downwards, z out of the plane it hangs in. Strands may come too near each
/// other: look at nearness().
[[nodiscard]] Curve hung(const Gauge& gauge, const Hanging& hanging, Dice& dice);

}  // namespace flowdlo::synth
