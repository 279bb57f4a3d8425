#include "eval/plots.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "eval/trials.hpp"

namespace flowdlo::eval {
namespace {

int pixels_of(const std::vector<std::uint8_t>& png, const cv::Vec3b& color) {
  const cv::Mat picture = cv::imdecode(png, cv::IMREAD_COLOR);
  int count = 0;
  for (int v = 60; v < picture.rows; ++v) {  // below the legend
    for (int u = 0; u < picture.cols; ++u) count += picture.at<cv::Vec3b>(v, u) == color ? 1 : 0;
  }
  return count;
}

constexpr int kRefined = 1;
const cv::Vec3b kColors[] = {{170, 170, 170}, {200, 140, 40}, {60, 160, 235}, {60, 60, 200}};

TEST(Plots, BarGrowsWithTheError) {
  const auto small = error_bars_png(std::vector<Trial>{test::trial("a", 4, 0.1, 2, 0.5)});
  const auto large = error_bars_png(std::vector<Trial>{test::trial("a", 4, 10, 2, 0.5)});
  ASSERT_TRUE(small);
  ASSERT_TRUE(large);
  // A tenth of a centimetre is one decade above the axis, ten are three.
  EXPECT_NEAR(pixels_of(*large, kColors[kRefined]), 3 * pixels_of(*small, kColors[kRefined]), 40);
  EXPECT_GT(pixels_of(*small, kColors[kRefined]), 500);
}

TEST(Plots, CurveHasALineAMethod) {
  std::vector<Trial> trials;
  for (int i = 1; i <= 20; ++i) trials.push_back(test::trial("a", 4 * i, 0.1 * i, 2 * i, 0.3 * i));
  const auto curve = error_curve_png(trials);
  ASSERT_TRUE(curve);
  for (const cv::Vec3b& color : kColors) EXPECT_GT(pixels_of(*curve, color), 100);
}

TEST(Plots, NoTrialsGiveAnEmptyPlot) {
  EXPECT_TRUE(error_bars_png({}));
  EXPECT_TRUE(error_curve_png({}));
}

}  // namespace
}  // namespace flowdlo::eval
