// Valleys: where the depth image runs deeper than on both sides, as it does between two strands.
#pragma once

#include "flowdlo/frame.hpp"
#include "image/image.hpp"

namespace flowdlo::path {

/// A crop of the frame in which valleys are measured.
struct ValleyView {
  image::Mask mask;        ///< 0 or 1: the strands
  image::Mask closed;      ///< the mask with its narrow slits filled; a slit is as deep as can be
  image::Rect box;         ///< where valleys are wanted
  image::Point offset_px;  ///< image position of (0, 0)
  float width_px = 1;      ///< the rope's, right to a factor of two
};

struct Valleys {
  image::Image<float> depth_m;  ///< below the mean of both sides, at least 0; 0 out of the mask
  float noise_m = 0;            ///< what is left of the sensor's in `depth_m`
  float radius_m = 0;           ///< of the rope; 0 when there is no depth at all
};

/// Sides are looked for within a strand, in eight directions; a step up on one side, steeper than
/// ropes lie, is no valley. Noisy depths are averaged along the valley.
[[nodiscard]] Valleys measure_valleys(const ValleyView& view, const Frame& frame);

/// How far `measure_valleys` looks beyond its box, pixels.
[[nodiscard]] int valley_margin(float width_px);

}  // namespace flowdlo::path
