// A small drawn frame of a closed ring: its ends are a guess, so that its mask is read in other
// ways as well.
#pragma once

#include <cmath>

#include "support/wave_frame.hpp"

namespace flowdlo::testing {

inline WaveFrame ring_frame() {
  constexpr float kRadius_px = 40;
  constexpr float kHalfRope_px = 3.5F;
  WaveFrame frame(160, 120);
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u) {
      const float from_centre_px = std::hypot(static_cast<float>(u) - frame.camera.cx,
                                              static_cast<float>(v) - frame.camera.cy);
      const bool rope = std::abs(from_centre_px - kRadius_px) <= kHalfRope_px;
      const auto pixel = static_cast<std::size_t>(v) * frame.width + static_cast<std::size_t>(u);
      frame.mask[pixel] = rope ? 255 : 0;
      frame.depth_m[pixel] = rope ? 0.4F : 0.0F;
    }
  }
  return frame;
}

}  // namespace flowdlo::testing
