#include "projected_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>

#include "tools/sample_estimate.hpp"

namespace flowdlo::tools {
namespace {

const Intrinsics kCamera{100.0F, 100.0F, 39.5F, 29.5F};

/// A loop that crosses itself once, at (39.5, 29.5): there node 9 meets node 54.
Centerline loop(bool start_is_upper) {
  Centerline nodes{};
  const float pi = std::acos(-1.0F);
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    const float angle = pi * (0.3F + 1.4F * static_cast<float>(j) / 63.0F);
    const float rise = 0.01F * static_cast<float>(j) / 63.0F;
    const float z = start_is_upper ? 0.5F + rise : 0.51F - rise;
    nodes[j] = {z * 0.2F * std::sin(2 * angle), z * 0.2F * std::cos(angle), z};
  }
  return nodes;
}

TEST(ProjectedCurve, NodesFallWhereThePinholeCameraSeesThem) {
  const ProjectedCurve curve(test::sample_estimate().nodes, kCamera, 1.0F);
  ASSERT_TRUE(curve.drawable());
  EXPECT_NEAR(curve.nodes_px()[0].x, 9.5F, 1e-4F);
  EXPECT_NEAR(curve.nodes_px()[63].x, 67.5F, 1e-4F);
  EXPECT_NEAR(curve.nodes_px()[63].y, 29.5F, 1e-4F);
}

TEST(ProjectedCurve, ZoomKeepsPixelCentresInTheMiddleOfTheirSquares) {
  Centerline nodes{};
  nodes.fill({0.0F, 0.0F, 0.5F});
  const ProjectedCurve curve(nodes, {100.0F, 100.0F, 0.0F, 0.0F}, 3.0F);
  EXPECT_NEAR(curve.nodes_px()[0].x, 1.0F, 1e-5F);  // the middle of columns 0 to 2
}

TEST(ProjectedCurve, NodesBehindTheCameraOrNotFiniteCannotBeDrawn) {
  auto nodes = test::sample_estimate().nodes;
  nodes[5].z = -0.5F;
  EXPECT_FALSE(ProjectedCurve(nodes, kCamera, 1.0F).drawable());
  nodes[5].z = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(ProjectedCurve(nodes, kCamera, 1.0F).drawable());
}

TEST(ProjectedCurve, StraightRopeCrossesNothing) {
  EXPECT_TRUE(ProjectedCurve(test::sample_estimate().nodes, kCamera, 1.0F).crossings().empty());
}

TEST(ProjectedCurve, NearerStrandOfACrossingIsTheUpper) {
  const auto start_above = ProjectedCurve(loop(true), kCamera, 1.0F).crossings();
  ASSERT_EQ(start_above.size(), 1U);
  EXPECT_NEAR(start_above[0].upper, 9.0, 0.1);
  const auto end_above = ProjectedCurve(loop(false), kCamera, 1.0F).crossings();
  ASSERT_EQ(end_above.size(), 1U);
  EXPECT_NEAR(end_above[0].upper, 54.0, 0.1);
}

TEST(ProjectedCurve, AdvancingStopsAtTheEnds) {
  const ProjectedCurve curve(test::sample_estimate().nodes, kCamera, 1.0F);
  EXPECT_DOUBLE_EQ(curve.advanced(2.0, -1000.0F), 0.0);
  EXPECT_DOUBLE_EQ(curve.advanced(2.0, 1000.0F), 63.0);
  EXPECT_NEAR(curve.advanced(10.0, 58.0F / 63.0F), 11.0, 1e-3);
}

TEST(ProjectedCurve, PieceRunsFromPositionToPosition) {
  const ProjectedCurve curve(test::sample_estimate().nodes, kCamera, 1.0F);
  const auto points = curve.piece(1.5, 3.5);
  ASSERT_EQ(points.size(), 4U);  // 1.5, 2, 3, 3.5
  EXPECT_NEAR(points.front().x, 9.5F + 1.5F * 58.0F / 63.0F, 1e-3F);
  EXPECT_NEAR(points.back().x, 9.5F + 3.5F * 58.0F / 63.0F, 1e-3F);
}

}  // namespace
}  // namespace flowdlo::tools
