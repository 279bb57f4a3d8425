// Square brush: erosion and dilation of masks by squares of any size, at the cost of one pixel
// each.
#pragma once

#include <opencv2/core.hpp>

namespace flowdlo::path {

/// The pixels of `mask` ([h, w] u8, 0 or 1) around which the square of `half` pixels to each side
/// is all set. What lies outside of the image is empty. Same shape, 0 or 1.
[[nodiscard]] cv::Mat eroded(const cv::Mat& mask, int half);

/// The pixels around which any of that square is set.
[[nodiscard]] cv::Mat dilated(const cv::Mat& mask, int half);

}  // namespace flowdlo::path
