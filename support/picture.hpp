// Picture: an image of 8 bits of blue, green and red a pixel.
#pragma once

#include <array>
#include <cstdint>

#include "image/image.hpp"

namespace flowdlo::support {

using Color = std::array<std::uint8_t, 3>;  ///< blue, green, red
using Picture = image::Image<Color>;
using ConstPicture = image::Image<const Color>;

/// How bright a colour is: 0.114 of blue, 0.587 of green and 0.299 of red (ITU-R BT.601), each in
/// units of 1 / 32768, rounded once.
[[nodiscard]] constexpr std::uint8_t grey_of(const Color& color) {
  return static_cast<std::uint8_t>((3735 * color[0] + 19235 * color[1] + 9798 * color[2] + 16384) >>
                                   15);
}

[[nodiscard]] constexpr Color color_of(std::uint8_t grey) { return {grey, grey, grey}; }

}  // namespace flowdlo::support
