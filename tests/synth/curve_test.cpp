#include "synth/curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace flowdlo::synth {
namespace {

constexpr double kPi = std::numbers::pi;

std::vector<Vector3d> arc(double radius_m, double angle, int count) {
  std::vector<Vector3d> points;
  for (int i = 0; i <= count; ++i) {
    const double a = angle * i / count;
    points.emplace_back(radius_m * std::cos(a), radius_m * std::sin(a), 0);
  }
  return points;
}

TEST(Curve, RespacedSamplesAreEvenlySpacedAndKeepTheEnds) {
  auto points = arc(0.1, 2.0, 300);
  points.erase(points.begin() + 20, points.begin() + 60);  // uneven
  const Curve curve = respaced(points, 0.002);

  EXPECT_EQ(curve.points.front(), points.front());
  EXPECT_EQ(curve.points.back(), points.back());
  EXPECT_EQ((curve.points.size() - 1) % 4, 0U);
  for (std::size_t i = 1; i < curve.points.size(); ++i) {
    EXPECT_NEAR((curve.points[i] - curve.points[i - 1]).norm(), curve.step_m, 0.01 * curve.step_m);
  }
}

TEST(Curve, BendRadiusOfACircleIsItsRadius) {
  const Curve curve = respaced(arc(0.05, 1.5 * kPi, 2000), 0.001);
  EXPECT_NEAR(least_bend_radius_m(curve, 0.004), 0.05, 0.0005);
}

TEST(Curve, ALoopCrossesItselfOnce) {
  std::vector<Vector2d> loop;  // half of a figure eight, and a little of its other half
  for (int i = 0; i <= 400; ++i) {
    const double a = -0.5 * kPi - 0.3 + (kPi + 0.6) * i / 400;
    loop.emplace_back(std::sin(2 * a), std::cos(a));
  }
  const auto found = crossings(loop);

  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT(found[0].first, found[0].second);
  EXPECT_GT(found[0].sine, 0.5);
}

TEST(Curve, AStraightLineDoesNotCrossItself) {
  std::vector<Vector2d> line;
  for (int i = 0; i < 200; ++i) line.emplace_back(0.01 * i, 0.003 * i);
  EXPECT_TRUE(crossings(line).empty());
}

// A hairpin of two straight strands `gap_m` apart.
Curve hairpin(double gap_m) {
  std::vector<Vector3d> points;
  for (int i = 0; i <= 200; ++i) points.emplace_back(0.001 * i, 0, 0);
  for (int i = 1; i < 40; ++i) {
    const double a = kPi * i / 40;
    points.emplace_back(0.2 + 0.5 * gap_m * std::sin(a), 0.5 * gap_m * (1 - std::cos(a)), 0);
  }
  for (int i = 200; i >= 0; --i) points.emplace_back(0.001 * i, gap_m, 0);
  return respaced(points, 0.001);
}

TEST(Nearness, TellsTheDistanceOfTwoStrands) {
  EXPECT_NEAR(nearness(hairpin(0.009), 0.004).least_m, 0.009, 1e-4);
}

TEST(Nearness, StrandsOfTwoRadiiAreInContactAndOfThreeAreNot) {
  EXPECT_GT(nearness(hairpin(0.008), 0.004).contact_m, 0.15);
  EXPECT_LT(nearness(hairpin(0.012), 0.004).contact_m, 0.02);
}

TEST(Nodes, AreUniformAndBeginAtTheSmallerX) {
  const Curve curve = respaced(arc(0.1, 2.5, 2000), 0.0005);  // from x = 0.1 to x = -0.08
  const Centerline nodes = nodes_of(curve);

  EXPECT_LT(nodes.front().x, nodes.back().x);
  const double even = curve.length_m() / (kNodes - 1);
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const double dx = nodes[i].x - nodes[i - 1].x;
    const double dy = nodes[i].y - nodes[i - 1].y;
    EXPECT_NEAR(std::hypot(dx, dy), even, 0.002 * even);
  }
}

}  // namespace
}  // namespace flowdlo::synth
