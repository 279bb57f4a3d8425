// FramePicture: a frame's colours and mask as images, and what overlays are drawn on.
#pragma once

#include <cstdint>

#include "flowdlo/estimate.hpp"
#include "flowdlo/frame.hpp"
#include "picture.hpp"

namespace flowdlo::tools {

/// The frame's own pixels, which it keeps; empty without any.
[[nodiscard]] support::ConstPicture colors_of(const Frame& frame);
[[nodiscard]] image::Image<const std::uint8_t> mask_of(const Frame& frame);

/// The colour image, or the mask where there is none, paler and darker, so that a curve stands out.
/// The frame's size.
[[nodiscard]] support::Picture paled(const Frame& frame);

/// Lays what the strand field says over `picture`, of the frame's size: axes coloured by direction,
/// tips white.
void tint(support::Picture& picture, const SeenStrands& strands);

/// What an overlay is drawn on: the paled frame, tinted where there are `strands`, with the mask's
/// outline. A whole multiple of the frame where that is under 480 px wide, so that every pixel of
/// the camera stays a square.
struct Ground {
  support::Picture picture;
  image::Mask rope;  ///< 255 where the mask is, else 0
  int zoom = 1;      ///< pixels of the picture for one of the camera
};
[[nodiscard]] Ground ground_of(const Frame& frame, const SeenStrands* strands = nullptr);

}  // namespace flowdlo::tools
