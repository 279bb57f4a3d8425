#include "baselines/mode_filter.hpp"

#include <opencv2/imgproc.hpp>

namespace flowdlo::baselines {

cv::Mat mode_filtered(const cv::Mat& mask, int size) {
  const auto sums = [&](const cv::Mat& values) {  // over windows, which the border cuts
    cv::Mat result;
    cv::boxFilter(values, result, CV_32F, {size, size}, {-1, -1}, false, cv::BORDER_CONSTANT);
    return result;
  };
  return 2 * sums(mask / 255) > sums(cv::Mat::ones(mask.size(), CV_8U));
}

}  // namespace flowdlo::baselines
