#include "baselines/strokes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "baselines/drawn.hpp"

namespace flowdlo::baselines {
namespace {

using test::drawn;
using testing::SizeIs;

TEST(Strokes, LineIsOneInOrder) {
  const cv::Mat line = drawn({{40, 60}, {200, 90}}, 1);
  const auto strokes = strokes_of(line, junction_pixels(line));
  ASSERT_THAT(strokes, SizeIs(1));
  EXPECT_NEAR(length_px(strokes[0]), 172, 3);
}

TEST(Strokes, CrossFallsIntoFour) {
  cv::Mat cross = drawn({{40, 100}, {200, 100}}, 1);
  drawn({{120, 30}, {120, 170}}, 1, cross);
  EXPECT_THAT(strokes_of(cross, junction_pixels(cross)), SizeIs(4));
}

TEST(Strokes, RingIsCutOpen) {
  cv::Mat ring = test::blank();
  cv::circle(ring, {160, 120}, 50, 255, 1);
  EXPECT_THAT(strokes_of(ring, test::blank()), SizeIs(1));
}

TEST(Strokes, DirectionPointsOutOfTheStroke) {
  Stroke stroke;
  for (int i = 0; i < 30; ++i) stroke.emplace_back(static_cast<float>(i), 5.0F);
  EXPECT_EQ(direction_out(stroke, true, 2, 6), cv::Point2f(1, 0));
  EXPECT_EQ(direction_out(stroke, false, 2, 6), cv::Point2f(-1, 0));
}

TEST(Strokes, DirectionOfASinglePixelIsNone) {
  EXPECT_EQ(direction_out({{3, 4}}, true, 2, 6), cv::Point2f(0, 0));
}

}  // namespace
}  // namespace flowdlo::baselines
