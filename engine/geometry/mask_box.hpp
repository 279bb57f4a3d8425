// MaskBox: where in a frame the mask lies.
#pragma once

#include <cstdint>

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

/// The first of `count` pixels, from the one at `from` on, that is above 127; `count` where none
/// is. Eight at a time, since most of an image is no mask.
[[nodiscard]] int first_masked(const std::uint8_t* pixels, int from, int count);

}  // namespace flowdlo::geometry
