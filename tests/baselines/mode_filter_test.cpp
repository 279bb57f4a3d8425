#include "baselines/mode_filter.hpp"

#include <gtest/gtest.h>

#include "baselines/drawn.hpp"

namespace flowdlo::baselines {
namespace {

cv::Mat strip(int width) {
  cv::Mat mask = test::blank();
  mask(cv::Rect(30, 100, 200, width)).setTo(255);
  return mask;
}

TEST(ModeFilter, StripUnderEightPixelsVanishes) {
  EXPECT_EQ(cv::countNonZero(mode_filtered(strip(7), 15)), 0);
}

TEST(ModeFilter, StripOfEightPixelsStays) {
  const cv::Mat filtered = mode_filtered(strip(8), 15);
  EXPECT_EQ(cv::countNonZero(filtered.col(130)), 8);
}

TEST(ModeFilter, HolesAreFilled) {
  cv::Mat mask = strip(40);
  mask.at<std::uint8_t>(120, 100) = 0;
  EXPECT_EQ(mode_filtered(mask, 15).at<std::uint8_t>(120, 100), 255);
}

}  // namespace
}  // namespace flowdlo::baselines
