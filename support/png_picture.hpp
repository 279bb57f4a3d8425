// PngPicture: PNG images as pictures and grey images of 8 bits, and back.
#pragma once

#include <cstdint>
#include <vector>

#include "flowdlo/result.hpp"
#include "frame/png.hpp"
#include "picture.hpp"

namespace flowdlo::support {

/// Of an image of any format: 16 bits are rounded to 8, grey becomes a colour, and what says how
/// opaque a pixel is is left out.
[[nodiscard]] Picture picture_of(const frame::PngImage& png);

/// The same of its greys: colours by grey_of.
[[nodiscard]] image::Image<std::uint8_t> grey_image_of(const frame::PngImage& png);

/// As frame::encode_png.
[[nodiscard]] Result<std::vector<std::uint8_t>> encode_png(const ConstPicture& picture);
[[nodiscard]] Result<std::vector<std::uint8_t>> encode_png(
    const image::Image<const std::uint8_t>& grey);

}  // namespace flowdlo::support
