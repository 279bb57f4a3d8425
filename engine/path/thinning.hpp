// Thinning: a mask to lines one pixel wide, of the same topology.
#pragma once

#include <opencv2/core.hpp>

namespace flowdlo::path {

/// The skeleton of `mask` ([h, w] u8, 0 or 1, its outermost pixels 0), same shape and values.
/// Every component keeps at least one pixel; deterministic.
[[nodiscard]] cv::Mat thin(const cv::Mat& mask);

}  // namespace flowdlo::path
