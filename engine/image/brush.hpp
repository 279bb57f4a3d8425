// Brush: erosion and dilation of masks by squares of any size.
#pragma once

#include "image/image.hpp"

namespace flowdlo::image {

/// The pixels of `mask` around which the square of `half` pixels to each side is all set. What lies
/// outside of the image is empty. The least of the square's values, so that 0 and 1, or 0 and 255,
/// stay what they are.
[[nodiscard]] Mask eroded(const Image<const std::uint8_t>& mask, int half);

/// The pixels around which any of that square is set: the largest of its values.
[[nodiscard]] Mask dilated(const Image<const std::uint8_t>& mask, int half);

}  // namespace flowdlo::image
