// JPEG images in memory, written by libjpeg.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace flowdlo::report {

/// `image` is 8 bits BGR; `quality` 1 to 100. Empty where it cannot be encoded.
[[nodiscard]] std::vector<std::uint8_t> encode_jpeg(const cv::Mat& image, int quality);

}  // namespace flowdlo::report
