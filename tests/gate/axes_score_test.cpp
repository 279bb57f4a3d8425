// How well curves agree with axes that are known: two legs of a hairpin a width apart, pixels of
// the frame.
#include "gate/axes_score.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace flowdlo::gate {
namespace {

using Eigen::Vector2f;
using Places = std::vector<Vector2f>;

constexpr float kWidth_px = 10;

/// About a pixel apart.
Places through(const Places& corners) {
  Places points{corners.front()};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const Vector2f way = corners[i] - corners[i - 1];
    const int steps = static_cast<int>(std::ceil(way.norm()));
    for (int k = 1; k <= steps; ++k) {
      points.push_back(corners[i - 1] + way * static_cast<float>(k) / static_cast<float>(steps));
    }
  }
  return points;
}

field::Axes axes_of(const std::vector<Places>& lines, const std::array<float, 2>& tips) {
  field::Axes axes;
  axes.width_px = kWidth_px;
  for (const Places& line : lines) axes.lines.push_back({through(line), tips, false});
  return axes;
}

ImageCurve curve_of(const Places& corners) {
  ImageCurve curve;
  curve.width_px = kWidth_px;
  const Places points = through(corners);
  float length_px = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vector2f step = points[i + 1] - points[i];
    curve.points.push_back({points[i], step.normalized(), 1, 0.5F * kWidth_px, length_px});
    length_px += step.norm();
  }
  return curve;
}

const Places kUpper{{50, 100}, {250, 100}};
const Places kLower{{50, 112}, {250, 112}};
const Places kFar{{50, 150}, {250, 150}};

TEST(AxesScore, ACurveAlongAllAxesFollowsThemAndIsBacked) {
  const auto score = score_axes(axes_of({kUpper, kLower}, {1, 0}),
                                curve_of({{50, 100}, {250, 100}, {250, 112}, {50, 112}}));
  EXPECT_TRUE(score.known);
  EXPECT_GT(score.followed, 0.97F);
  EXPECT_GT(score.backed, 0.95F);
  EXPECT_EQ(score.twice, 0);
  EXPECT_EQ(score.tips_met, 1);
  EXPECT_EQ(score.tips_left, 0);
}

TEST(AxesScore, AStrandThatIsLeftOutIsNotFollowed) {
  const auto score = score_axes(axes_of({kUpper, kFar}, {1, 0}), curve_of(kUpper));
  EXPECT_NEAR(score.followed, 0.5F, 0.02F);
  EXPECT_GT(score.backed, 0.97F);
  EXPECT_EQ(score.tips_met, 0.5F);   // of its two ends one is at a tip
  EXPECT_EQ(score.tips_left, 0.5F);  // and the other strand's tip is left
}

TEST(AxesScore, ACurveBetweenTwoStrandsIsBackedByNeither) {
  const auto score =
      score_axes(axes_of({kUpper, kLower}, {0, 0}), curve_of({{50, 106}, {250, 106}}));
  EXPECT_EQ(score.followed, 0);
  EXPECT_EQ(score.backed, 0);
}

TEST(AxesScore, ACurveThatCrossesAnAxisDoesNotRunAlongIt) {
  const auto score = score_axes(axes_of({kUpper}, {0, 0}), curve_of({{150, 50}, {150, 150}}));
  EXPECT_EQ(score.followed, 0);
  EXPECT_EQ(score.backed, 0);
}

TEST(AxesScore, AnAxisThatIsRunAlongTwiceIsToldFromOne) {
  const auto score =
      score_axes(axes_of({kUpper}, {1, 1}),
                 curve_of({{50, 100}, {250, 100}, {250, 160}, {50, 160}, {50, 101}, {250, 101}}));
  EXPECT_GT(score.twice, 0.9F);
  EXPECT_GT(score.followed, 0.97F);
}

TEST(AxesScore, TheDirectionOfTravelDoesNotMatter) {
  const auto axes = axes_of({kUpper, kLower}, {0.8F, 0.1F});
  const auto there = score_axes(axes, curve_of(kUpper));
  const auto back = score_axes(axes, curve_of({kUpper[1], kUpper[0]}));
  EXPECT_EQ(there.followed, back.followed);
  EXPECT_EQ(there.tips_met, back.tips_met);
}

TEST(AxesScore, WithoutACurveNothingIsFollowed) {
  const auto score = score_axes(axes_of({kUpper}, {1, 1}), {});
  EXPECT_TRUE(score.known);
  EXPECT_EQ(score.followed, 0);
  EXPECT_EQ(score.backed, 0);
}

TEST(AxesScore, WithoutAxesNothingBacksACurve) {
  const auto score = score_axes({{}, kWidth_px}, curve_of(kUpper));
  EXPECT_TRUE(score.known);
  EXPECT_EQ(score.followed, 0);
  EXPECT_EQ(score.backed, 0);
}

}  // namespace
}  // namespace flowdlo::gate
