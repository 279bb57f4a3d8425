// Masks: what is asked of one pixel by pixel.
#pragma once

#include "image/image.hpp"

namespace flowdlo::image {

using ConstMask = Image<const std::uint8_t>;

[[nodiscard]] int count_set(const ConstMask& mask);

/// `value` where `image` is above `threshold`, else 0.
[[nodiscard]] Mask above(const ConstMask& image, std::uint8_t threshold, std::uint8_t value);
[[nodiscard]] Mask above(const Image<const float>& image, float threshold, std::uint8_t value);

/// 1 where `mask` is empty.
[[nodiscard]] Mask inverse(const ConstMask& mask);

/// Whether both, of one size, are set in the same places.
[[nodiscard]] bool same(const ConstMask& a, const ConstMask& b);

/// 1 where more than half of the square of `side` (odd) pixels around is set; none lie beyond the
/// image.
[[nodiscard]] Mask majority(const ConstMask& mask, int side);

}  // namespace flowdlo::image
