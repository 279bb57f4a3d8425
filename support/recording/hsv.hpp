// Hsv: a colour's hue, saturation and value, in OpenCV's units of 8 bits.
#pragma once

#include <array>
#include <cstdint>

#include "picture.hpp"

namespace flowdlo::recording {

/// Hue 0..179 (red, green and blue are 0, 60 and 120), saturation and value 0..255. Greys have hue
/// and saturation 0. The same numbers as OpenCV's.
[[nodiscard]] std::array<int, 3> hsv_of(const support::Color& color);

/// Inclusive bounds. A lower bound of the hue above the upper one goes through red.
struct HsvRange {
  std::array<int, 3> low{};
  std::array<int, 3> high{};
};

/// [h, w] 255 where the colour is within `range`, else 0.
[[nodiscard]] image::Mask hsv_mask(const support::ConstPicture& color, const HsvRange& range);

}  // namespace flowdlo::recording
