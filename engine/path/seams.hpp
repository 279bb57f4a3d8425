// Seams: the valleys of the depth between strands that touch in the mask.
#pragma once

#include "flowdlo/frame.hpp"
#include "image/image.hpp"

namespace flowdlo::path {

/// What the seams of a mask are looked for with.
struct SeamScale {
  image::Point offset_px;  ///< image position of the mask's (0, 0)
  float width_px = 1;      ///< the rope's, right to a factor of two
  float narrow_px = 1;     ///< of its narrow parts
};

/// Where the depth shows two strands beside each other that are one in `mask` ([h, w] u8, 0 or 1,
/// its outermost pixels 0): lines along the valley between them and what slivers they cut off,
/// [h, w] u8, 0 or 1; an empty matrix where there are none. Strands that lie in the same line
/// through the mask's own slits are one seam. Only long seams deeper than the noise count: a
/// crossing has none.
[[nodiscard]] image::Mask find_seams(const image::Mask& mask, const SeamScale& scale,
                                     const Frame& frame);

}  // namespace flowdlo::path
