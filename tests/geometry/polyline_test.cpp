#include "geometry/polyline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace flowdlo::geometry {
namespace {

using Points = std::vector<Eigen::Vector2f>;

Centerline row_of_nodes(float spacing) {
  Centerline nodes{};
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = {static_cast<float>(i) * spacing, 0, 1};
  return nodes;
}

// A right triangle's legs and hypotenuse: 3, then 4, then 5.
TEST(CumulativeLength, AddsUpSegmentsAsEquation3_1) {
  const Points points{{0, 0}, {3, 0}, {3, 4}, {0, 0}};
  EXPECT_EQ(cumulative_length(points), (std::vector<float>{0, 3, 7, 12}));
}

TEST(CumulativeLength, StandsStillAtRepeatedPoints) {  // Eq. (3.1)
  const Points points{{0, 0}, {0, 2}, {0, 2}, {0, 3}};
  EXPECT_EQ(cumulative_length(points), (std::vector<float>{0, 2, 2, 3}));
}

TEST(CumulativeLength, MeasuresSpaceAsItDoesTheImage) {  // Eq. (3.1)
  const std::vector<Eigen::Vector3f> points{{0, 0, 0}, {2, 3, 6}};
  EXPECT_EQ(cumulative_length(points), (std::vector<float>{0, 7}));
}

// 30 px along u, 33 along v: 63 px, so that node i lies at arclength i.
TEST(Resample, PlacesNodesAtUniformArclengthAroundACorner) {  // Eq. (3.2)
  const Points nodes = resample(Points{{0, 0}, {30, 0}, {30, 33}}, 64);
  ASSERT_EQ(nodes.size(), 64U);
  EXPECT_NEAR((nodes[12] - Eigen::Vector2f(12, 0)).norm(), 0, 1e-4);
  EXPECT_NEAR((nodes[30] - Eigen::Vector2f(30, 0)).norm(), 0, 1e-4);
  EXPECT_NEAR((nodes[40] - Eigen::Vector2f(30, 10)).norm(), 0, 1e-4);
}

TEST(Resample, KeepsBothEndsExactly) {  // Sec. 3.3, below Eq. (3.2)
  const Points path{{0.1F, 0.7F}, {13.3F, 5.9F}, {77.7F, 91.1F}};
  const Points nodes = resample(path, 64);
  EXPECT_EQ(nodes.front(), path.front());
  EXPECT_EQ(nodes.back(), path.back());
}

TEST(Resample, IgnoresHowDenselyTheInputIsSampled) {  // Eq. (3.2)
  Points dense;
  for (int i = 0; i <= 10000; ++i) dense.emplace_back(static_cast<float>(i) * 0.05F, 7);
  const Points nodes = resample(dense, 64);
  for (int i = 0; i < 64; ++i) {
    EXPECT_NEAR(nodes[static_cast<std::size_t>(i)].x(), 500.0 * i / 63, 2e-3) << "node " << i;
  }
}

TEST(Resample, RepeatsTheOnlyPlaceOfAPolylineWithoutLength) {
  for (const Points& points : {Points{{4, 5}}, Points{{4, 5}, {4, 5}, {4, 5}}}) {
    for (const Eigen::Vector2f& node : resample(points, 64)) {
      EXPECT_EQ(node, Eigen::Vector2f(4, 5));
    }
  }
}

TEST(Length, IsTheSumOfTheSegmentsOfEquation3_30) {
  EXPECT_EQ(length(row_of_nodes(0.25F)), 15.75F);  // 63 * 0.25
}

TEST(SegmentLengths, AreTheDistancesOfEquation3_30) {
  Centerline nodes = row_of_nodes(0.5F);
  nodes[1] = {0, 3, 5};  // from (0, 0, 1): sqrt(9 + 16) = 5
  const auto lengths = segment_lengths(nodes);
  EXPECT_EQ(lengths[0], 5.0);
  EXPECT_EQ(lengths[2], 0.5);
}

TEST(SegmentLengths, DoNotOverflowOnFiniteNodes) {  // Eq. (3.30)
  Centerline nodes = row_of_nodes(0);
  nodes[7].x = std::numeric_limits<float>::max();
  EXPECT_TRUE(std::isfinite(segment_lengths(nodes)[7]));
}

TEST(AllFinite, FailsForANanAndForAnInfinityAnywhere) {
  EXPECT_TRUE(all_finite(row_of_nodes(1)));
  Centerline nodes = row_of_nodes(1);
  nodes[63].z = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(all_finite(nodes));
  nodes = row_of_nodes(1);
  nodes[0].y = -std::numeric_limits<float>::infinity();
  EXPECT_FALSE(all_finite(nodes));
}

}  // namespace
}  // namespace flowdlo::geometry
