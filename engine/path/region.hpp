// Region: the part of the mask worth thinning. Specks are gone and highlights are filled; holes
// that tell a loop's direction stay.
#pragma once

#include <Eigen/Core>

#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "image/image.hpp"

namespace flowdlo::path {

struct Region {
  image::Point offset_px;           ///< image position of the crop's (0, 0)
  image::Mask mask;                 ///< 0 or 1, with at least two empty pixels on every side
  image::Image<float> distance_px;  ///< to the nearest empty pixel
  float width_px = 0;               ///< the rope's width, a first guess
  bool filtered = false;            ///< as Strokes::filtered
};

/// Image position of the crop's (0, 0).
[[nodiscard]] inline Eigen::Vector2f offset_of(const Region& region) {
  return {static_cast<float>(region.offset_px.x), static_cast<float>(region.offset_px.y)};
}

/// The rope's width where the distance to the nearest empty pixel is `distance_px`: 2 d - 1 for
/// odd widths, 2 d for even ones; between the two here.
[[nodiscard]] inline float width_at(float distance_px) { return 2.0F * distance_px - 0.5F; }

/// Whether a pixel of `mask`, or the one nearest to `p`, is set; false outside.
[[nodiscard]] bool lit(const image::Mask& mask, int u, int v);
[[nodiscard]] bool lit(const image::Mask& mask, const Eigen::Vector2f& p);

/// Crops and cleans the mask. Fails with kNoPath when it is empty, holds specks only, or more
/// strokes than one rope, or several, can have made (`strokes_of`).
[[nodiscard]] Result<Region> clean(const Frame& frame, int ropes = 1);

/// `region` after a majority filter over squares of `size_px` (odd), for frayed borders and noise;
/// unchanged when nothing would be left of it.
[[nodiscard]] Region smoothed(const Region& region, int size_px);

}  // namespace flowdlo::path
