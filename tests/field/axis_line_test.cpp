#include "field/axis_line.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "field/channel.hpp"
#include "field/region.hpp"
#include "support/painted_field.hpp"

namespace flowdlo::field {
namespace {

using Eigen::Vector2f;
using testing::arc_axis;
using testing::painted_field;
using testing::show_tip;
using testing::straight_axis;
using Curve = testing::Axis;

float length_of(const AxisLine& line) { return static_cast<float>(line.points_px.size()); }

/// How far the points of a line lie off a curve at most.
float farthest(const AxisLine& line, const Curve& curve) {
  float most = 0;
  for (const Vector2f& p : line.points_px) {
    float off = 1e9F;
    for (const Vector2f& q : curve) off = std::min(off, (p - q).norm());
    most = std::max(most, off);
  }
  return most;
}

TEST(AxisLines, OneStrandIsOneLineFromEndToEnd) {
  const Curve curve = straight_axis({20, 30}, {130, 110});
  Channels field = painted_field({curve});
  show_tip(field, curve.front());
  const auto lines = axis_lines(field);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NEAR(length_of(lines[0]), 136, 8);
  EXPECT_LT(farthest(lines[0], curve), 2.6F);  // an end reaches a little beyond
  const bool forwards = (lines[0].points_px.front() - curve.front()).norm() < 8;
  EXPECT_GT(lines[0].tips[forwards ? 0 : 1], 0.9F);
  EXPECT_LT(lines[0].tips[forwards ? 1 : 0], 0.1F);
}

TEST(AxisLines, AtACrossingTheUpperStrandGoesOnAndTheLowerEnds) {
  const Curve lower = straight_axis({20, 80}, {140, 80});
  const Curve upper = straight_axis({60, 20}, {100, 140});
  const auto lines = axis_lines(painted_field({lower, upper}));
  ASSERT_EQ(lines.size(), 3U);
  int whole = 0;
  for (const AxisLine& line : lines) {
    const bool of_upper = farthest(line, upper) < 2.6F;
    EXPECT_TRUE(of_upper || farthest(line, lower) < 2.6F);
    if (of_upper) {
      ++whole;
      EXPECT_NEAR(length_of(line), 126, 10);
    } else {
      EXPECT_NEAR(length_of(line), 55, 8);
    }
  }
  EXPECT_EQ(whole, 1);
}

TEST(AxisLines, StrandsSideBySideAreLinesOfTheirOwn) {
  const Curve one = straight_axis({20, 60}, {140, 70});
  const Curve other = straight_axis({20, 68}, {140, 78});
  const auto lines = axis_lines(painted_field({one, other}));
  ASSERT_EQ(lines.size(), 2U);
  for (const AxisLine& line : lines) {
    EXPECT_LT(std::min(farthest(line, one), farthest(line, other)), 2.6F);
    EXPECT_NEAR(length_of(line), 122, 8);
  }
}

TEST(AxisLines, ARingIsClosedUnlessAnEndShows) {
  constexpr float kAround = 2 * std::numbers::pi_v<float>;
  const Curve ring = arc_axis({80, 80}, 50, 0, kAround);
  Channels field = painted_field({ring});
  const auto closed = axis_lines(field);
  ASSERT_EQ(closed.size(), 1U);
  EXPECT_TRUE(closed[0].closed);
  EXPECT_NEAR(length_of(closed[0]), 314, 12);
  const Vector2f tip(80, 130);
  show_tip(field, tip);
  const auto open = axis_lines(field);
  ASSERT_EQ(open.size(), 1U);
  EXPECT_FALSE(open[0].closed);
  EXPECT_LT((open[0].points_px.front() - tip).norm(), 4);
  EXPECT_LT((open[0].points_px.back() - tip).norm(), 8);
  EXPECT_GT(std::min(open[0].tips[0], open[0].tips[1]), 0.5F);
}

TEST(AxisLines, ARingBeginsWhereItLooksMostLikeAnEnd) {
  constexpr float kAround = 2 * std::numbers::pi_v<float>;
  Channels field = painted_field({arc_axis({80, 80}, 50, 0, kAround)});
  const Vector2f faint(30, 80);
  field.at(80, 30)[kTip] = 0.2F;  // too little to open it
  const auto lines = axis_lines(field);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(lines[0].closed);
  EXPECT_LT((lines[0].points_px.front() - faint).norm(), 4);
}

TEST(AxisLines, ALoopIsNoRing) {
  constexpr float kTurn = 2 * std::numbers::pi_v<float>;
  Curve upper = straight_axis({40, 130}, {110, 60});
  for (const Curve& next : {arc_axis({92.3F, 42.3F}, 25, kTurn / 8, -5 * kTurn / 8),
                            straight_axis({74.6F, 60}, {87.3F, 72.7F})}) {
    upper.insert(upper.end(), next.begin() + 1, next.end());
  }
  const Curve lower = straight_axis({87.3F, 72.7F}, {135, 120.4F});  // and below itself
  Channels field = painted_field({lower, upper});
  const Vector2f crossing(92.3F, 77.7F);
  for (int v = 0; v < field.height(); ++v) {
    for (int u = 0; u < field.width(); ++u) {  // so that a line begins at the crossing
      const Vector2f p(static_cast<float>(u), static_cast<float>(v));
      if ((p - crossing).norm() > 2) field.at(v, u)[kCentre] *= 0.9F;
    }
  }
  const auto lines = axis_lines(field);
  EXPECT_FALSE(lines.empty());
  for (const AxisLine& line : lines) EXPECT_FALSE(line.closed);
}

TEST(AxisLines, WhereTwoEndsTouchTheLineIsCut) {
  Channels field = painted_field({straight_axis({20, 80}, {140, 80})});
  show_tip(field, {90, 80});
  const auto lines = axis_lines(field);
  ASSERT_EQ(lines.size(), 2U);
  for (const AxisLine& line : lines) {
    EXPECT_GT(std::max(line.tips[0], line.tips[1]), 0.5F);
    EXPECT_LT(std::min(line.tips[0], line.tips[1]), 0.1F);
  }
}

TEST(AxisLines, AStrandWiderThanBelievedIsOneLine) {
  const Curve curve = straight_axis({20, 60}, {140, 90});
  const auto lines = axis_lines(painted_field({curve}, {160, 160}, 2.5F * kRope_px));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NEAR(length_of(lines[0]), 124, 14);
}

TEST(AxisLines, ALineThatTurnsWhereAnotherOneComesCloseIsCutThere) {
  // Each strand bends away from the other in the middle, as if both had changed over at a crossing.
  Curve one = straight_axis({20, 40}, {78, 77});
  const Curve on = straight_axis({82, 77}, {140, 40});
  one.insert(one.end(), on.begin(), on.end());
  Curve other = straight_axis({20, 120}, {78, 83});
  const Curve away = straight_axis({82, 83}, {140, 120});
  other.insert(other.end(), away.begin(), away.end());
  const auto lines = axis_lines(painted_field({one, other}, {160, 160}, 6));
  EXPECT_EQ(lines.size(), 4U);
  for (const AxisLine& line : lines) EXPECT_LT(length_of(line), 75);
}

TEST(AxisLines, AFieldOfNothingHasNone) { EXPECT_TRUE(axis_lines(Channels({64, 64}, {})).empty()); }

TEST(AxisLines, AnyFieldEndsAndGivesTheSameLines) {
  Channels field({96, 96}, {});
  std::mt19937 random(7);
  std::uniform_real_distribution<float> value(-1, 1);
  for (int i = 0; i < field.size().area(); ++i) {
    for (float& channel : field.at(i / 96, i % 96)) channel = value(random);
  }
  const auto first = axis_lines(field);
  const auto second = axis_lines(field);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_GE(first[i].points_px.size(), 2U);
    EXPECT_EQ(first[i].points_px, second[i].points_px);
  }
}

}  // namespace
}  // namespace flowdlo::field
