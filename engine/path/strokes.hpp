// Strokes: how long what a mask shows would be as one line, and whether a rope can be that long.
#pragma once

#include <cstdint>

#include "flowdlo/result.hpp"
#include "image/image.hpp"

namespace flowdlo::path {

/// Half of the mask's border pixels: a stroke has one on each side. `mask` is 0 or 1,
/// its outermost pixels 0.
[[nodiscard]] std::int64_t stroke_length_px(const image::Mask& mask);

struct Strokes {
  image::Mask mask;       ///< 0 or 1
  bool filtered = false;  ///< the mask given is noise or texture, and this is what a filter left
};

/// `mask` as it is where one rope, or several, can have made it in an image of that size.
/// Otherwise after a majority filter, the smallest that leaves a mask which one rope can have made:
/// noise goes, a rope under it stays. Fails with kNoPath where none does. One pass over the mask,
/// four with filters.
[[nodiscard]] Result<Strokes> strokes_of(image::Mask mask, const image::Size& image, int ropes = 1);

}  // namespace flowdlo::path
