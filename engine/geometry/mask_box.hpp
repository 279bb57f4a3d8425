// Where in a frame the mask lies.
#pragma once

#include <cstdint>

#include "flowdlo/frame.hpp"
#include "image/rect.hpp"

namespace flowdlo::geometry {

/// The smallest rectangle that holds all pixels above 127; empty without any.
[[nodiscard]] image::Rect mask_box(const Frame& frame);

/// The first of `count` pixels, from the one at `from` on, that is above 127; `count` where none
/// is. Eight at a time, since most of an image is no mask.
[[nodiscard]] int first_masked(const std::uint8_t* pixels, int from, int count);

}  // namespace flowdlo::geometry
