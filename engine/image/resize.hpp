// Resize: images at another size.
#pragma once

#include <array>

#include "image/image.hpp"

namespace flowdlo::image {

/// Each pixel becomes that of `image` which lies under its upper left corner.
template <class T>
[[nodiscard]] Image<T> nearest(const Image<const T>& image, const Size& size);

/// Each pixel becomes the bilinear value at its centre; beyond its outermost pixels' centres an
/// image stays as it is there. float, and three of them.
template <class T>
[[nodiscard]] Image<T> bilinear(const Image<const T>& image, const Size& size);

/// Each pixel becomes the mean of what lies under it. std::uint8_t, rounded, float, and three of
/// them. Where one side grows it is bilinear between pixels that keep their value wherever they
/// cover a whole pixel.
template <class T>
[[nodiscard]] Image<T> area_mean(const Image<const T>& image, const Size& size);

}  // namespace flowdlo::image
