// Straight: strands that a test can say everything about.
#pragma once

#include <cmath>

#include "strand/patch.hpp"

namespace flowdlo::strand {

/// From one pixel to another, half a pixel a step, 8 px wide, half a metre away.
inline Strand straight(float u0, float v0, float u1, float v1, int rope = 0, float depth_m = 0.5F) {
  Strand strand;
  strand.rope = rope;
  const float length = std::hypot(u1 - u0, v1 - v0);
  const int steps = static_cast<int>(2 * length);
  for (int i = 0; i <= steps; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(steps);
    strand.points.push_back(
        {u0 + t * (u1 - u0), v0 + t * (v1 - v0), 4, depth_m, t * length / 8, Seen::kYes});
  }
  return strand;
}

}  // namespace flowdlo::strand
