#include "geometry/smooth_curve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/polyline.hpp"

namespace flowdlo::geometry {
namespace {

constexpr float kRadius_m = 0.05F;

/// Nodes on a coil of one and a half turns.
Centerline coil() {
  Centerline nodes;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double angle = 3 * std::numbers::pi * static_cast<double>(i) / (kNodes - 1);
    nodes[i] = {kRadius_m * static_cast<float>(std::cos(angle)),
                kRadius_m * static_cast<float>(std::sin(angle)),
                0.5F + 0.01F * static_cast<float>(angle)};
  }
  return nodes;
}

/// One centimetre a node along x, then as far along y: a right angle at node 32.
Centerline corner() {
  Centerline nodes;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const float along = 0.01F * static_cast<float>(i);
    nodes[i] = {std::min(along, 0.32F), std::max(0.0F, along - 0.32F), 0.5F};
  }
  return nodes;
}

double nearest(const Point3& place, const std::vector<Point3>& curve) {
  double least = std::numeric_limits<double>::infinity();
  for (const Point3& point : curve) least = std::min(least, distance(place, point));
  return least;
}

TEST(SmoothCurve, BeginsAndEndsWhereTheNodesDo) {
  const auto curve = smooth_curve(coil(), 2);
  ASSERT_EQ(curve.size(), 2U);
  EXPECT_EQ(curve.front(), coil().front());
  EXPECT_EQ(curve.back(), coil().back());
}

TEST(SmoothCurve, GoesThroughEveryNode) {
  const auto curve = smooth_curve(coil(), 60001);
  for (const Point3& node : coil()) EXPECT_LT(nearest(node, curve), 1e-5);
}

TEST(SmoothCurve, IsUniformInArclength) {
  const auto curve = smooth_curve(coil(), 512);
  double least = std::numeric_limits<double>::infinity();
  double most = 0;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    const double step = distance(curve[i - 1], curve[i]);
    least = std::min(least, step);
    most = std::max(most, step);
  }
  EXPECT_LT(most, 1.002 * least);
}

TEST(SmoothCurve, LiesTenTimesNearerToACircleThanChordsDo) {
  const double turn = 3 * std::numbers::pi / (kNodes - 1);
  const double sagitta = kRadius_m * (1 - std::cos(turn / 2));
  for (const Point3& point : smooth_curve(coil(), 1000)) {
    const double off = std::hypot(static_cast<double>(point.x), static_cast<double>(point.y)) -
                       static_cast<double>(kRadius_m);
    EXPECT_LT(std::abs(off), sagitta / 10);
  }
}

TEST(SmoothCurve, ASharpBendIsRoundedByLessThanATenthOfTheNodesDistance) {
  for (const Point3& point : smooth_curve(corner(), 2000)) {
    const double to_first = std::hypot(std::max(0.0, static_cast<double>(point.x) - 0.32),
                                       static_cast<double>(point.y));
    const double to_second = std::hypot(static_cast<double>(point.x) - 0.32,
                                        std::min(0.0, static_cast<double>(point.y)));
    EXPECT_LT(std::min(to_first, to_second), 0.1 * 0.01);
  }
}

TEST(SmoothCurve, OnALineItNeverTurnsBackHoweverUnevenTheNodes) {
  Centerline nodes;
  float x = 0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    nodes[i] = {x, 0.1F, 0.5F};
    x += i % 3 == 0 ? 0.1F : 0.0001F;
  }
  const auto curve = smooth_curve(nodes, 5000);
  for (std::size_t i = 1; i < curve.size(); ++i) {
    EXPECT_GE(curve[i].x, curve[i - 1].x);
    EXPECT_FLOAT_EQ(curve[i].y, 0.1F);
    EXPECT_FLOAT_EQ(curve[i].z, 0.5F);
  }
}

TEST(SmoothCurve, NodesInOnePlaceCountOnce) {
  Centerline stays = corner();
  std::fill(stays.begin() + 10, stays.begin() + 20, stays[10]);
  for (const Point3& point : smooth_curve(stays, 3000)) {
    EXPECT_TRUE(std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z));
    EXPECT_LE(point.x, 0.3215F);
  }
  Centerline same;
  same.fill({0.1F, 0.2F, 0.3F});
  const std::vector<Point3> expected(7, Point3{0.1F, 0.2F, 0.3F});
  EXPECT_EQ(smooth_curve(same, 7), expected);
}

TEST(SmoothCurve, TwoPlacesAreALine) {
  Centerline nodes;
  nodes.fill({0, 0, 0.5F});
  nodes.back() = {0.3F, 0, 0.5F};
  const auto curve = smooth_curve(nodes, 4);
  EXPECT_NEAR(curve[1].x, 0.1F, 1e-4);
  EXPECT_NEAR(curve[2].x, 0.2F, 1e-4);
}

TEST(SmoothCurve, OfTheLargestNodesIsFinite) {
  Centerline nodes;
  for (std::size_t i = 0; i < kNodes; ++i) nodes[i] = {i % 2 == 0 ? -3e38F : 3e38F, 0, 1};
  for (const Point3& point : smooth_curve(nodes, 500)) EXPECT_TRUE(std::isfinite(point.x));
}

}  // namespace
}  // namespace flowdlo::geometry
