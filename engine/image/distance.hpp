// Distance: from each pixel of a mask to the nearest one that is empty.
#pragma once

#include "image/image.hpp"

namespace flowdlo::image {

/// Pixels, within 2 % of the Euclidean distance: the shortest way of steps to the side (1), aslant
/// (1.4) and of a knight (2.1969), in units of 1 / 65536. Where nothing is empty, 8192.
[[nodiscard]] Image<float> distance_to_empty(const Image<const std::uint8_t>& mask);

/// visit(distance) for each pixel that is as far from what is empty as its four neighbours or
/// farther: the middle of a stroke, half as wide. None at the image's border.
template <class Visit>
void for_ridges(const Image<const float>& distance, const Visit& visit) {
  for (int v = 1; v + 1 < distance.height(); ++v) {
    const float* up = distance.row(v - 1);
    const float* row = distance.row(v);
    const float* down = distance.row(v + 1);
    for (int u = 1; u + 1 < distance.width(); ++u) {
      const float d = row[u];
      if (d <= 0 || d < row[u - 1] || d < row[u + 1] || d < up[u] || d < down[u]) continue;
      visit(d);
    }
  }
}

}  // namespace flowdlo::image
