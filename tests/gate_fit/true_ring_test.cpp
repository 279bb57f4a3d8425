#include "gate_fit/true_ring.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "geometry/polyline.hpp"

namespace flowdlo::lab {
namespace {

/// An ellipse, told from a share of it on, node 63 next to node 0.
Centerline ellipse(double from) {
  Centerline nodes;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double angle = 2 * std::numbers::pi * (from + static_cast<double>(i) / kNodes);
    nodes[i] = {static_cast<float>(0.11 * std::cos(angle)),
                static_cast<float>(0.1 * std::sin(angle)), 0.5F};
  }
  return nodes;
}

TEST(TrueRing, IsToldFromWhereTheFoundOneBegins) {
  for (const double from : {0.0, 0.123, 0.5, 0.87}) {
    const Centerline truth = true_ring(ellipse(0), ellipse(from));
    EXPECT_LT(geometry::mean_distance(truth, ellipse(from)), 0.002) << from;
    EXPECT_GT(geometry::mean_distance(truth, ellipse(from + 0.25)), 0.05) << from;
  }
}

TEST(TrueRing, MayRunTheOtherWayRound) {
  Centerline found = ellipse(0.3);
  std::reverse(found.begin(), found.end());
  EXPECT_LT(geometry::mean_distance(true_ring(ellipse(0), found), found), 0.002);
}

TEST(TrueRing, WhoseLastNodeIsItsFirstIsTheSame) {
  Centerline closed;  // as TrueRope::nodes has it
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / (kNodes - 1);
    closed[i] = {static_cast<float>(0.11 * std::cos(angle)),
                 static_cast<float>(0.1 * std::sin(angle)), 0.5F};
  }
  EXPECT_LT(geometry::mean_distance(true_ring(closed, ellipse(0.4)), ellipse(0.4)), 0.002);
}

}  // namespace
}  // namespace flowdlo::lab
