// Where in a frame the mask lies.
#pragma once

#include <cstddef>
#include <cstdint>

#include "flowdlo/frame.hpp"
#include "image/rect.hpp"

namespace flowdlo::geometry {

/// The smallest rectangle that holds all pixels above 127; empty without any.
[[nodiscard]] image::Rect mask_box(const Frame& frame);

/// The first of `count` pixels, from the one at `from` on, that is above 127; `count` where none
/// is. Eight at a time, since most of an image is no mask.
[[nodiscard]] int first_masked(const std::uint8_t* pixels, int from, int count);

/// `visit(u, v, index)` of every pixel above 127, row by row.
template <class Visit>
void each_masked(const Frame& frame, const Visit& visit) {
  for (int v = 0; v < frame.height; ++v) {
    const std::size_t first = static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.width);
    const std::uint8_t* const row = frame.mask.data() + first;
    for (int u = first_masked(row, 0, frame.width); u < frame.width;
         u = first_masked(row, u + 1, frame.width)) {
      visit(u, v, first + static_cast<std::size_t>(u));
    }
  }
}

}  // namespace flowdlo::geometry
