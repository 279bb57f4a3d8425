#include "reference/block_image.hpp"

#include <algorithm>
#include <cstddef>

namespace flowdlo::reference {
namespace {

std::ptrdiff_t place(int v, int u, int side, int channels) {
  return (static_cast<std::ptrdiff_t>(v) * side + u) * channels;
}

}  // namespace

void max_pool(const float* x, int side, int channels, float* y) {
  const int half = side / 2;
  for (int v = 0; v < half; ++v) {
    for (int u = 0; u < half; ++u) {
      const float* const a = x + place(2 * v, 2 * u, side, channels);
      const float* const b = a + place(1, 0, side, channels);
      float* const to = y + place(v, u, half, channels);
      for (int c = 0; c < channels; ++c) {
        to[c] = std::max(std::max(a[c], a[c + channels]), std::max(b[c], b[c + channels]));
      }
    }
  }
}

void add_upsampled(const float* x, int side, int channels, float* y) {
  for (int v = 0; v < side; ++v) {
    for (int u = 0; u < side; ++u) {
      const float* const from = x + place(v / 2, u / 2, side / 2, channels);
      float* const to = y + place(v, u, side, channels);
      for (int c = 0; c < channels; ++c) to[c] += from[c];
    }
  }
}

}  // namespace flowdlo::reference
