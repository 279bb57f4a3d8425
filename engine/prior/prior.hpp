// Prior: the path lifted to 64 ordered 3D nodes with support, Eq. (3.1)-(3.7).
#pragma once

#include <array>
#include <cstdint>

#include "evidence/visible_points.hpp"
#include "flowdlo/centerline.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "path/path.hpp"

namespace flowdlo::prior {

/// Thresholds in pixels of a 640-px-wide image; scaled by width / 640 where used.
struct LiftConfig {
  float lift_radius_px = 12.0F;  ///< r_px, Eq. (3.3)
  float arc_window_px = 36.0F;   ///< r_arc, Eq. (3.3)
  float sigma_px = 6.0F;         ///< Eq. (3.4)
  float sigma_arc_px = 12.0F;    ///< Eq. (3.4)
};

/// sigma_m of `lift` is not calibrated; for that of `refine` see there. Supported: the spread of
/// the points behind the node together with 1 mm and one pixel's width. Others: a supported
/// neighbour's, and half of the gap to it.
struct Prior {
  Centerline nodes{};                          ///< X_prior, canonical direction
  std::array<std::uint8_t, kNodes> support{};  ///< h_i, Eq. (3.6)
  std::array<float, kNodes> sigma_m{};         ///< spread of what backs a node; grows over gaps
};

/// Fails with kNoEvidence when no visible point supports any node, with kNoPath when the path has
/// fewer than two points or one that is not finite.
[[nodiscard]] Result<Prior> lift(const path::Path& path, const evidence::VisiblePoints& visible,
                                 const Frame& frame, const LiftConfig& config = {});

/// True when `nodes` already run in the canonical direction: smaller x first, then y, then z.
[[nodiscard]] bool is_canonical(const Centerline& nodes);

}  // namespace flowdlo::prior
