// Depth: which values of a depth image are measurements, and how far a unit of one goes.
#pragma once

#include <cstdint>

namespace flowdlo::geometry {

inline constexpr float kLeastDepth_m = 1e-6F;  ///< Sec. 3.2
inline constexpr float kMostDepth_m = 1000;    ///< no camera measures so far; no product overflows

/// Whether something was measured at a pixel that holds `depth_m`: not so for what is not finite.
[[nodiscard]] inline bool measured(float depth_m) {
  return depth_m > kLeastDepth_m && depth_m < kMostDepth_m;
}

/// Metres of a pixel of a 16-bit image, whose unit is `scale_m` metres.
[[nodiscard]] inline float metres(std::uint16_t units, double scale_m) {
  return static_cast<float>(units * scale_m);
}

}  // namespace flowdlo::geometry
