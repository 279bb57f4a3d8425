#include "path/thinning.hpp"
#include "mat/mat_image.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace flowdlo::path {
namespace {

cv::Mat thinned(const cv::Mat& mask) {
  return mat::mat_of(thin(mat::image_of<std::uint8_t>(mask)));
}

int components(const cv::Mat& mask) {
  cv::Mat labels;
  return cv::connectedComponents(mask, labels, 8) - 1;
}

cv::Mat noise(int percent) {
  cv::Mat mask = cv::Mat::zeros(200, 260, CV_8U);
  cv::RNG random(static_cast<std::uint64_t>(percent));
  for (int v = 2; v < 198; ++v) {
    for (int u = 2; u < 258; ++u) mask.at<std::uint8_t>(v, u) = random.uniform(0, 100) < percent;
  }
  return mask;
}

TEST(Thinning, KeepsEveryComponentAndHole) {
  for (const int percent : {10, 30, 50, 70, 90}) {
    const cv::Mat mask = noise(percent);

    const cv::Mat lines = thinned(mask);

    EXPECT_EQ(components(lines), components(mask)) << percent;
    cv::Mat labels;
    EXPECT_EQ(cv::connectedComponents(mask == 0, labels, 4),
              cv::connectedComponents(lines == 0, labels, 4))
        << percent;
  }
}

TEST(Thinning, StaysInsideTheMask) {
  const cv::Mat mask = noise(60);
  EXPECT_EQ(cv::countNonZero(thinned(mask) & ~(mask * 255)), 0);
}

TEST(Thinning, LinesAreOnePixelWide) {  // no pixel of a stroke's skeleton turns a square corner
  cv::Mat mask = cv::Mat::zeros(200, 260, CV_8U);
  cv::ellipse(mask, {130, 100}, {80, 50}, 20, 0, 300, cv::Scalar(1), 13);
  const cv::Mat lines = thinned(mask);
  for (int v = 1; v < 199; ++v) {
    for (int u = 1; u < 259; ++u) {
      const cv::Mat square = lines(cv::Rect{u, v, 2, 2});
      EXPECT_LT(cv::countNonZero(square), 3) << u << " " << v;
    }
  }
}

TEST(Thinning, LeavesAOnePixelLineAlone) {
  cv::Mat mask = cv::Mat::zeros(60, 60, CV_8U);
  cv::line(mask, {10, 10}, {40, 40}, cv::Scalar(1), 1);
  EXPECT_EQ(cv::countNonZero(thinned(mask) != mask), 0);
}

TEST(Thinning, DoesNotEatTwoPixelDiagonalsFromTheirEnds) {
  cv::Mat mask = cv::Mat::zeros(120, 120, CV_8U);
  for (int i = 10; i < 100; ++i) mask.at<std::uint8_t>(i, i) = mask.at<std::uint8_t>(i, i + 1) = 1;
  EXPECT_GE(cv::countNonZero(thinned(mask)), 85);
}

TEST(Thinning, MidlineOfABarLiesWithinAPixelOfTheMiddle) {
  cv::Mat mask = cv::Mat::zeros(80, 300, CV_8U);
  mask(cv::Rect{20, 30, 260, 21}) = 1;
  const cv::Mat lines = thinned(mask);
  for (int u = 60; u < 240; ++u) {
    int lit = 0;
    for (int v = 0; v < 80; ++v) {
      if (lines.at<std::uint8_t>(v, u) == 0) continue;
      ++lit;
      EXPECT_NEAR(v, 40, 1);
    }
    EXPECT_EQ(lit, 1);
  }
}

}  // namespace
}  // namespace flowdlo::path
