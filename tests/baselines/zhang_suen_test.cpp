#include "baselines/zhang_suen.hpp"

#include <gtest/gtest.h>

#include "baselines/drawn.hpp"
#include "baselines/strokes.hpp"

namespace flowdlo::baselines {
namespace {

TEST(ZhangSuen, StripBecomesItsMiddleLine) {
  cv::Mat mask = test::blank();
  mask(cv::Rect(30, 100, 200, 9)).setTo(255);
  const cv::Mat line = zhang_suen(mask);
  EXPECT_EQ(cv::countNonZero(line.col(130)), 1);
  EXPECT_EQ(line.at<std::uint8_t>(104, 130), 255);
}

TEST(ZhangSuen, RingKeepsItsHole) {
  cv::Mat mask = test::blank();
  cv::circle(mask, {160, 120}, 50, 255, 9);
  cv::Mat labels;
  EXPECT_EQ(cv::connectedComponents(zhang_suen(mask) == 0, labels, 4), 3);  // OpenCV counts 0 too
}

TEST(ZhangSuen, SlopesHaveNoCorners) {
  const cv::Mat line = zhang_suen(test::drawn({{40, 60}, {240, 200}}, 9));
  EXPECT_EQ(cv::countNonZero(junction_pixels(line)), 0);
}

TEST(ZhangSuen, ImagesTooSmallForANeighbourhoodAreEmpty) {
  EXPECT_EQ(cv::countNonZero(zhang_suen(cv::Mat(2, 2, CV_8U, cv::Scalar(255)))), 0);
}

}  // namespace
}  // namespace flowdlo::baselines
