// Pixel: which one a place in the image lies in.
#pragma once

#include <algorithm>
#include <cmath>

namespace flowdlo::geometry {

/// The whole number next to a coordinate, halves away from zero: std::lround of a finite value,
/// clamped to 1e9 either way, without the call into the C library that this costs where a stage
/// asks for millions of pixels.
inline int nearest_px(float coordinate_px) {
  const auto exact = static_cast<double>(coordinate_px);
  return static_cast<int>(std::clamp(exact + std::copysign(0.5, exact), -1e9, 1e9));
}

}  // namespace flowdlo::geometry
