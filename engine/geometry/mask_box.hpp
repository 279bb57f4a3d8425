// MaskBox: where in a frame the mask lies.
#pragma once

#include "flowdlo/frame.hpp"

namespace flowdlo::geometry {

/// Pixels of the frame; both sides 0 without any mask.
struct MaskBox {
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
};

/// The smallest rectangle that holds all pixels above 127.
[[nodiscard]] MaskBox mask_box(const Frame& frame);

}  // namespace flowdlo::geometry
