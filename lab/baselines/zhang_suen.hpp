// Zhang-Suen thinning (CACM 1984), the one thinning of all baselines.
#pragma once

#include <opencv2/core.hpp>

namespace flowdlo::baselines {

/// `mask` [h, w] u8, set where not 0, to lines of 255 one pixel wide. Pixels of the image's outer
/// border count as empty. Staircases lose their corners, as Lee thinning leaves none.
[[nodiscard]] cv::Mat zhang_suen(const cv::Mat& mask);

}  // namespace flowdlo::baselines
