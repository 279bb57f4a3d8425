// Brush: erosion and dilation of masks by squares and discs of any size.
#pragma once

#include "image/image.hpp"

namespace flowdlo::image {

/// The pixels of `mask` around which the square of `half` pixels to each side is all set. What lies
/// outside of the image is empty. The least of the square's values, so that 0 and 1, or 0 and 255,
/// stay what they are.
[[nodiscard]] Mask eroded(const Image<const std::uint8_t>& mask, int half);

/// The pixels around which any of that square is set: the largest of its values.
[[nodiscard]] Mask dilated(const Image<const std::uint8_t>& mask, int half);

/// The pixels around which a disc of that radius is all set; what lies outside of the image does
/// not count.
[[nodiscard]] Mask eroded_by_disc(const Image<const std::uint8_t>& mask, int radius);

}  // namespace flowdlo::image
