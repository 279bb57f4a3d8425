// Beside the rope: the depth of what lies there, clear of what a camera mixes with the rope.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <vector>

#include "flowdlo/frame.hpp"
#include "geometry/camera.hpp"
#include "geometry/depth.hpp"
#include "geometry/pixel.hpp"
#include "geometry/quantile.hpp"

namespace flowdlo::evidence {

/// Where it is read: beyond the mask's edge, pixels.
struct BesideRope {
  int clear_px = 2;  ///< from here on the mask may not reach,
  int from_px = 5;   ///< from here on depths are read: clear of a stereo camera's window,
  int to_px = 10;    ///< and up to here

  /// Of an image so many pixels wide; `clear_px` stays.
  [[nodiscard]] static BesideRope of_width(int width) {
    const float scale = geometry::pixel_scale(width);
    BesideRope at;
    at.from_px = static_cast<int>(std::lround(static_cast<float>(at.from_px) * scale));
    at.to_px = static_cast<int>(std::lround(static_cast<float>(at.to_px) * scale));
    return at;
  }
  /// From the mask's edge to the middle of where depths are read.
  [[nodiscard]] float middle_px() const { return 0.5F * static_cast<float>(from_px + to_px); }
};

inline constexpr std::size_t kLeastBeside = 3;  ///< depths

/// Metres: the middle of the depths from `edge_px` on along the unit vector `outward`; 0 where
/// fewer than kLeastBeside are measured, or the mask lies there.
[[nodiscard]] inline float depth_beside(const Eigen::Vector2f& edge_px,
                                        const Eigen::Vector2f& outward, const BesideRope& at,
                                        const Frame& frame) {
  std::vector<float> depths;
  depths.reserve(static_cast<std::size_t>(at.to_px));
  for (int step = at.clear_px; step <= at.to_px; ++step) {
    const Eigen::Vector2f p = edge_px + static_cast<float>(step) * outward;
    const int u = geometry::nearest_px(p.x());
    const int v = geometry::nearest_px(p.y());
    if (u < 0 || v < 0 || u >= frame.width || v >= frame.height) continue;
    const std::size_t pixel = static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.width) +
                              static_cast<std::size_t>(u);
    if (frame.mask[pixel] > 127) return 0;
    if (step < at.from_px) continue;
    if (geometry::measured(frame.depth_m[pixel])) depths.push_back(frame.depth_m[pixel]);
  }
  return depths.size() < kLeastBeside ? 0 : geometry::median_of(depths);
}

}  // namespace flowdlo::evidence
