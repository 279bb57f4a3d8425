// Region: the part of a frame that holds the rope, resampled so that the rope is as wide there
// whatever the camera: a network of a few layers sees as far as it needs to, and no farther.
#pragma once

#include <Eigen/Core>

#include "image/rect.hpp"

namespace flowdlo::field {

/// Width of the rope in a region, pixels of the region.
inline constexpr float kRope_px = 8;

/// What lies around the mask's box: widths of the rope and pixels of the frame.
inline constexpr float kMarginWidths = 3;
inline constexpr float kMargin_px = 4;

/// A thinner rope is not magnified beyond this: there is nothing more to see. Chosen on `wide`
/// training scenes (docs/field.md).
inline constexpr float kMostScale = 3;

struct Region {
  image::Rect box;                    ///< pixels of the frame
  image::Size size;                   ///< pixels of the region, at least 16 x 16
  Eigen::Vector2f scale{1.0F, 1.0F};  ///< pixels of the region a pixel of the frame, in u and v

  /// Centres of pixels are whole numbers in both.
  [[nodiscard]] Eigen::Vector2f to_region(const Eigen::Vector2f& frame_px) const;
  [[nodiscard]] Eigen::Vector2f to_frame(const Eigen::Vector2f& region_px) const;

  /// The rope's width that it was made for, pixels of the frame.
  [[nodiscard]] float magnified_for_px() const;
};

/// Of a mask within `mask_box` of a frame; `rope_width_px` is the rope's width there, frame pixels,
/// and above 0. Expects a box that is not empty.
[[nodiscard]] Region region_around(const image::Rect& mask_box, const image::Size& frame,
                                   float rope_width_px);

}  // namespace flowdlo::field
