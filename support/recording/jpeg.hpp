// JPEG images in memory, read by libjpeg.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>

namespace flowdlo::recording {

enum class JpegColors { kBgr, kGrey };

/// 8 bits, of at most `most_px` a side, as it lies in the file: an orientation noted beside it is
/// not followed. Empty where `bytes` are no such image, or a damaged one.
[[nodiscard]] cv::Mat decode_jpeg(std::span<const std::uint8_t> bytes, JpegColors colors,
                                  int most_px);

}  // namespace flowdlo::recording
