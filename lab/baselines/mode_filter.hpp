// ModeFilter: each pixel becomes the most frequent value around it.
#pragma once

#include <opencv2/core.hpp>

namespace flowdlo::baselines {

/// `mask` is [h, w] u8, 0 or 255; `size` odd. Windows end at the image's border; a tie gives 0.
/// A stroke along an axis of at most size / 2 pixels vanishes, field section 1, point 3.
[[nodiscard]] cv::Mat mode_filtered(const cv::Mat& mask, int size);

}  // namespace flowdlo::baselines
