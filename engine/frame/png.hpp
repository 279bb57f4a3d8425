// PNG images in memory, by libpng: OpenCV's own reader brings a hundred libraries and 40 MB along.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string>
#include <vector>

#include "flowdlo/result.hpp"

namespace flowdlo::frame {

/// The image as stored: 8 or 16 bits a channel, 1, 3 (BGR) or 4 (BGRA) channels, at most
/// kMaxSide_px a side. Fails with kBadInput when `bytes` is no whole PNG; the message begins with
/// `who`, the file's name.
[[nodiscard]] Result<cv::Mat> decode_png(std::span<const std::uint8_t> bytes,
                                         const std::string& who);

/// Fails with kInternal.
[[nodiscard]] Result<std::vector<std::uint8_t>> encode_png(const cv::Mat& image);

}  // namespace flowdlo::frame
