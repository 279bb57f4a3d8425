#include "geometry/ring.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "geometry/polyline.hpp"

namespace flowdlo::geometry {
namespace {

/// An ellipse, told from a share of it on, once round.
Centerline ellipse(double from) {
  Centerline nodes;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double angle = 2 * std::numbers::pi * (from + static_cast<double>(i) / (kNodes - 1));
    nodes[i] = {static_cast<float>(0.11 * std::cos(angle)),
                static_cast<float>(0.1 * std::sin(angle)), 0.5F};
  }
  return nodes;
}

TEST(ToldLike, BeginsWhereTheOtherRingDoes) {
  for (const double from : {0.0, 0.123, 0.5, 0.87}) {
    const Centerline told = told_like(ellipse(0), ellipse(from)).nodes;
    EXPECT_LT(mean_distance(told, ellipse(from)), 0.002) << from;
    EXPECT_GT(mean_distance(told, ellipse(from + 0.25)), 0.05) << from;
  }
}

TEST(ToldLike, RunsTheOtherWayRoundWhereTheOtherRingDoes) {
  Centerline found = ellipse(0.3);
  std::reverse(found.begin(), found.end());
  const auto told = told_like(ellipse(0), found);
  for (std::size_t i = 0; i < kNodes; ++i) EXPECT_LT(distance(told.nodes[i], found[i]), 0.004);
  EXPECT_LT(mean_distance(told_like(ellipse(0), found).nodes, found), 0.002);
}

TEST(ToldLike, SaysWhichNodeEachWas) {
  const Centerline ring = ellipse(0);
  const auto told = told_like(ring, ellipse(0.25));
  EXPECT_EQ(told.from[0], 16U);  // of 63 steps
  for (std::size_t i = 0; i < kNodes; ++i) {
    EXPECT_LT(distance(told.nodes[i], ring[told.from[i]]), 0.006);
  }
}

TEST(MeanDistance, OfRingsIsTheSameWhereverTheyBegin) {
  Centerline moved = ellipse(0.61);
  for (Point3& node : moved) node.z += 0.02F;
  EXPECT_NEAR(mean_distance(ellipse(0.2), moved, true), 0.02, 0.0005);
  EXPECT_GT(mean_distance(ellipse(0.2), moved, false), 0.05);
}

TEST(ToldLike, GoesOnToItsFirstNodeWhereTheLastIsShortOfIt) {
  Centerline open;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / kNodes;
    open[i] = {static_cast<float>(0.11 * std::cos(angle)),
               static_cast<float>(0.1 * std::sin(angle)), 0.5F};
  }
  const auto told = told_like(open, ellipse(0.4));
  EXPECT_LT(mean_distance(told.nodes, ellipse(0.4)), 0.002);
  EXPECT_LT(distance(told.nodes.front(), told.nodes.back()), 1e-6);
}

}  // namespace
}  // namespace flowdlo::geometry
