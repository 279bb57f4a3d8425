// Erosion and dilation by squares are those of OpenCV, whatever the size of the square.
#include "path/square_brush.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace flowdlo::test {
namespace {

// Blobs that touch the border, one pixel in 40 flipped.
cv::Mat blobs(int width, int height, std::uint64_t seed) {
  cv::Mat mask = cv::Mat::zeros(height, width, CV_8U);
  cv::RNG random(seed);
  for (int i = 0; i < 12; ++i) {
    cv::circle(mask, {random.uniform(0, width), random.uniform(0, height)},
               random.uniform(2, width / 3), cv::Scalar(1), cv::FILLED);
  }
  for (int i = 0; i < width * height / 40; ++i) {
    mask.at<std::uint8_t>(random.uniform(0, height), random.uniform(0, width)) ^= 1;
  }
  return mask;
}

class SquareBrush : public testing::TestWithParam<int> {};

TEST_P(SquareBrush, ErodesAsOpenCvDoesAndTakesTheOutsideForEmpty) {
  const int half = GetParam();
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const cv::Mat mask = blobs(180, 120, seed) | (seed == 3 ? 1 : 0);
    cv::Mat expected;
    cv::erode(mask, expected, cv::Mat::ones(2 * half + 1, 2 * half + 1, CV_8U), {-1, -1}, 1,
              cv::BORDER_CONSTANT, cv::Scalar(0));
    EXPECT_EQ(cv::countNonZero(path::eroded(mask, half) != expected), 0) << "seed " << seed;
  }
}

TEST_P(SquareBrush, DilatesAsOpenCvDoes) {
  const int half = GetParam();
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    cv::Mat mask = cv::Mat::zeros(120, 180, CV_8U);
    cv::RNG random(seed);
    for (int i = 0; i < 6; ++i) {
      mask.at<std::uint8_t>(random.uniform(0, 120), random.uniform(0, 180)) = 1;
    }
    cv::Mat expected;
    cv::dilate(mask, expected, cv::Mat::ones(2 * half + 1, 2 * half + 1, CV_8U));
    EXPECT_EQ(cv::countNonZero(path::dilated(mask, half) != expected), 0) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(HalfSizes, SquareBrush, testing::Values(1, 5, 16, 17, 25, 70, 200));

}  // namespace
}  // namespace flowdlo::test
