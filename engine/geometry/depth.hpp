// Depth: which values of a depth image are measurements.
#pragma once

namespace flowdlo::geometry {

inline constexpr float kLeastDepth_m = 1e-6F;  ///< Sec. 3.2
inline constexpr float kMostDepth_m = 1000;    ///< no camera measures so far; no product overflows

/// Whether something was measured at a pixel that holds `depth_m`: not so for what is not finite.
[[nodiscard]] inline bool measured(float depth_m) {
  return depth_m > kLeastDepth_m && depth_m < kMostDepth_m;
}

}  // namespace flowdlo::geometry
