// JPEG images in memory, read by libjpeg.
#pragma once

#include <cstdint>
#include <span>

#include "picture.hpp"

namespace flowdlo::recording {

/// Of at most `most_px` a side, as it lies in the file: an orientation noted beside it is not
/// followed. Empty where `bytes` are no such image, or a damaged one.
[[nodiscard]] support::Picture decode_jpeg(std::span<const std::uint8_t> bytes, int most_px);

/// The same of its greys alone.
[[nodiscard]] image::Image<std::uint8_t> decode_grey_jpeg(std::span<const std::uint8_t> bytes,
                                                          int most_px);

}  // namespace flowdlo::recording
