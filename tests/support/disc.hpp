// Disc: what a round brush touches in an image.
#pragma once

#include <cmath>
#include <cstddef>

namespace flowdlo::testing {

/// Calls `paint` with each pixel of a disc that lies whole in an image of that width, and with the
/// square of its distance from the middle, 1 at the edge.
template <class Paint>
void paint_disc(float u, float v, int radius_px, int width, const Paint& paint) {
  for (int y = -radius_px; y <= radius_px; ++y) {
    for (int x = -radius_px; x <= radius_px; ++x) {
      if (x * x + y * y > radius_px * radius_px) continue;
      const auto column = static_cast<std::size_t>(std::lround(u) + x);
      const auto row = static_cast<std::size_t>(std::lround(v) + y);
      paint(row * static_cast<std::size_t>(width) + column,
            static_cast<float>(x * x + y * y) / static_cast<float>(radius_px * radius_px));
    }
  }
}

}  // namespace flowdlo::testing
