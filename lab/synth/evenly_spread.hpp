// EvenlySpread: which scenes of a set are of a kind that a share of them has.
#pragma once

#include <cmath>
#include <cstdint>

namespace flowdlo::synth {

/// Whether `scene`, counted from 0, is one of a share [0, 1] of all that is evenly spread.
[[nodiscard]] inline bool evenly_spread(double share, std::uint64_t scene) {
  const auto so_far = [&](std::uint64_t scenes) {
    return std::floor(share * static_cast<double>(scenes));
  };
  return so_far(scene + 1) > so_far(scene);
}

}  // namespace flowdlo::synth
