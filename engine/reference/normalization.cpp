#include "reference/normalization.hpp"

#include <cmath>

namespace flowdlo::reference {

void frame_normalization(std::span<const float> points, std::span<float> norm) {
  constexpr float kSmallestScale = 1e-6F;
  float sum[3] = {0, 0, 0};
  float count = 0;
  for (std::size_t row = 0; row + 4 <= points.size(); row += 4) {
    if (points[row + 3] <= 0.5F) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += points[row + axis];
    count += 1;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) norm[axis] = count > 0 ? sum[axis] / count : 0;

  float square = 0;  // Eq. (3.9)
  for (std::size_t row = 0; row + 4 <= points.size(); row += 4) {
    if (points[row + 3] <= 0.5F) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float difference = points[row + axis] - norm[axis];
      square += difference * difference;
    }
  }
  const float scale = count > 0 ? std::sqrt(square / count) : 0;
  norm[3] = scale < kSmallestScale ? 1.0F : scale;
}

void normalize(std::span<const float> points, std::span<const float> norm, std::span<float> out) {
  for (std::size_t row = 0; row + 4 <= points.size(); row += 4) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      out[row + axis] = (points[row + axis] - norm[axis]) / norm[3];  // Eq. (3.10)
    }
    out[row + 3] = points[row + 3];
  }
}

void denormalize(std::span<const float> state, std::span<const float> norm, std::span<float> out) {
  for (std::size_t row = 0; row + 4 <= state.size(); row += 4) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      out[row + axis] = norm[3] * state[row + axis] + norm[axis];  // Eq. (3.10)
    }
    out[row + 3] = state[row + 3];
  }
}

}  // namespace flowdlo::reference
