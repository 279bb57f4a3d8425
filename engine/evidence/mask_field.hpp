// MaskField: what the local features of Eq. (3.15) read at a node's projection. Spec section 6.
#pragma once

#include <vector>

#include "flowdlo/frame.hpp"

namespace flowdlo::evidence {

/// Half-resolution image of four channels, interleaved: 0 mask (area average, 0..1), 1 the same
/// after a Gaussian of sigma 2.5 half-resolution px, 2 and 3 the displacement (u, v) from the
/// pixel's centre to the centre of the nearest mask pixel, in half-resolution px. A field pixel
/// counts as mask where channel 0 is above zero; of equally near ones the upper, then the left one
/// is the nearest. Outside the image there is no mask. Without any mask pixel the displacement is
/// one field width in both directions, more than the local features tell apart.
struct MaskField {
  int width = 0;              ///< max(1, frame.width / 2)
  int height = 0;             ///< max(1, frame.height / 2)
  std::vector<float> texels;  ///< [height, width, 4]
};

inline constexpr int kLocalFeaturesVersion = 1;  ///< stands in the weights' metadata

[[nodiscard]] MaskField mask_field(const Frame& frame);

}  // namespace flowdlo::evidence
