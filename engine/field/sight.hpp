// Sight: what a camera shows of a region, and what of it the network is given.
#pragma once

#include <array>

#include "field/block_map.hpp"
#include "field/region.hpp"
#include "flowdlo/frame.hpp"
#include "image/image.hpp"

namespace flowdlo::field {

using Color = std::array<float, 3>;

/// Images of one size.
struct Sight {
  image::Image<Color> color;    ///< BGR, 0 to 1; empty: none, or one colour everywhere
  image::Image<float> mask;     ///< 0 to 1: share of the pixel that the mask covers
  image::Image<float> depth_m;  ///< 0: none
  image::Image<float> inside;   ///< 1 within the camera's image, 0 beyond
  float focal_px = 0;           ///< fx in pixels of this image
};

/// Expects a valid frame.
[[nodiscard]] Sight look(const Frame& frame, const Region& region);

/// Planes of the network's input, in this order.
enum Plane {
  kBlue,      ///< less the rope's median, over twice the rope's spread; within 3 either way
  kGreen,     ///< likewise
  kRed,       ///< likewise
  kHasColor,  ///< 1 or 0
  kDepth,     ///< less the depth of the rope around, in units of two rope widths; likewise
  kHasDepth,  ///< 1 or 0
  kMask,      ///< 0 to 1
  kPlanes
};

using Planes = image::Image<std::array<float, kPlanes>>;

/// The same for every rope, camera and distance as far as that can be had. Beyond the camera's
/// image all planes are 0.
[[nodiscard]] Planes input_of(const Sight& sight);

/// Of these blocks alone; what the other pixels hold is nobody's business.
[[nodiscard]] Planes input_of(const Sight& sight, const BlockMap& blocks);

}  // namespace flowdlo::field
