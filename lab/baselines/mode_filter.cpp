#include "baselines/mode_filter.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace flowdlo::baselines {

cv::Mat mode_filtered(const cv::Mat& mask, int size) {
  const int reach = size / 2;
  cv::Mat sums;
  cv::integral(mask / 255, sums, CV_32S);
  cv::Mat result(mask.size(), CV_8U);
  for (int v = 0; v < mask.rows; ++v) {
    const int top = std::max(0, v - reach);
    const int bottom = std::min(mask.rows, v + reach + 1);
    for (int u = 0; u < mask.cols; ++u) {
      const int left = std::max(0, u - reach);
      const int right = std::min(mask.cols, u + reach + 1);
      const int set = sums.at<int>(bottom, right) - sums.at<int>(top, right) -
                      sums.at<int>(bottom, left) + sums.at<int>(top, left);
      result.at<std::uint8_t>(v, u) = 2 * set > (bottom - top) * (right - left) ? 255 : 0;
    }
  }
  return result;
}

}  // namespace flowdlo::baselines
