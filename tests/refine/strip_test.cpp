#include "refine/strip.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "geometry/camera.hpp"
#include "refine/local_frame.hpp"
#include "support/straight_rope.hpp"

namespace flowdlo::refine {
namespace {

using testing::StraightRope;

float at(const Strip& strip, int station, int column) {
  return strip.values[static_cast<std::size_t>(station * weights::kRefineInputs + column)];
}

/// Deep, radii.
float way_to_table(const Strip& strip, const Curve& curve, std::size_t node) {
  const auto frames = local_frames(curve.nodes);
  return (strip.table_share[node] - 1) *
         geometry::to_eigen(curve.nodes[node]).dot(frames[node]->deep) / curve.radius_m;
}

TEST(Strip, ShowsMaskAndDepthAcrossTheRope) {
  const StraightRope rope;
  const auto strip = strip_along(rope.curve(), rope.frame());
  ASSERT_TRUE(strip);
  ASSERT_EQ(strip->values.size(), static_cast<std::size_t>(kStations * weights::kRefineInputs));
  for (int station = 4; station < kStations - 4; ++station) {
    for (int k = 0; k < kAcross; ++k) {
      const float widths = (static_cast<float>(k) - 7.5F) * kAcrossSpacing;
      if (std::abs(std::abs(widths) - 0.5F) < 0.15F) continue;  // the border's pixels
      const bool inside = std::abs(widths) < 0.5F;
      EXPECT_EQ(at(*strip, station, kMasked * kAcross + k), inside ? 1 : 0) << station << " " << k;
      EXPECT_EQ(at(*strip, station, kMeasured * kAcross + k), 1);
      // On the rope the surface is a radius nearer than the axis; the table lies a radius deeper.
      EXPECT_NEAR(at(*strip, station, kDepthOnMask * kAcross + k), 0, 1e-3F);
      EXPECT_NEAR(at(*strip, station, kDepthBeside * kAcross + k), inside ? 0 : 2, 1e-3F);
    }
    EXPECT_NEAR(at(*strip, station, kTurn), 0, 1e-3F);
    EXPECT_EQ(at(*strip, station, kInside), 1);
  }
  EXPECT_EQ(at(*strip, 0, kMasked * kAcross + 7), 0);  // beyond the end
}

TEST(Strip, DepthThatIsTooDeepShowsInRadii) {
  const StraightRope rope(0.5F * StraightRope::kRadius_m);
  const auto strip = strip_along(rope.curve(), rope.frame());
  ASSERT_TRUE(strip);
  EXPECT_NEAR(at(*strip, 128, kDepthOnMask * kAcross + 7), 0.5F, 1e-3F);
}

TEST(Strip, SaysHowFarNodesLieFromTheTable) {
  StraightRope rope;
  const auto mask = rope.frame().mask;
  for (std::size_t i = 0; i < mask.size(); ++i) {  // 4 mm off either way, in stretches of 8 px
    if (mask[i] == 0) rope.depth_m()[i] += i % StraightRope::kWidth / 8 % 2 == 0 ? 4e-3F : -4e-3F;
  }
  auto curve = rope.curve();
  for (Point3& node : curve.nodes) {  // two radii too deep
    const float share = 1 + 2 * StraightRope::kRadius_m / node.z;
    node = {share * node.x, share * node.y, share * node.z};
  }
  const auto strip = strip_along(curve, rope.frame());
  ASSERT_TRUE(strip);
  for (std::size_t i = 0; i < kNodes; ++i) {
    EXPECT_NEAR(way_to_table(*strip, curve, i), -2, 0.15F);
    const auto station = static_cast<int>(i) * kStationsOfNode;
    EXPECT_NEAR(at(*strip, station, kTable), std::asinh(way_to_table(*strip, curve, i)) / 2, 1e-6F);
    EXPECT_NEAR(at(*strip, station, kTableOff), -10.0F / (1.4826F * 4) / 3, 0.1F);
    EXPECT_EQ(at(*strip, station, kTableNear), 1);
    EXPECT_EQ(at(*strip, station, kTableSeen), 1);
    EXPECT_EQ(at(*strip, station, kTableKnown), 1);
  }
  EXPECT_EQ(at(*strip, 128, kGroundSides), 1);
}

/// The rope on its table, but for nodes `first` to `last`: these are read ten radii too near.
Curve arched(const StraightRope& rope, std::size_t first, std::size_t last) {
  Curve curve = rope.curve();
  for (std::size_t i = first; i <= last; ++i) {
    Point3& node = curve.nodes[i];
    const float share = 1 - 10 * StraightRope::kRadius_m / node.z;
    node = {share * node.x, share * node.y, share * node.z};
    curve.unseen_m[i] = 0.01F;
  }
  return curve;
}

TEST(Strip, ARopeOnItsTableMayHaveALongWayToItWhereNothingSupportsIt) {
  const StraightRope rope;
  const Curve curve = arched(rope, 20, 39);
  const auto strip = strip_along(curve, rope.frame());
  ASSERT_TRUE(strip);
  EXPECT_NEAR(way_to_table(*strip, curve, 30), 10, 0.3F);
  EXPECT_NEAR(way_to_table(*strip, curve, 10), 0, 0.02F);
  EXPECT_NEAR(at(*strip, 40, kTableSeen), 44.0F / 64, 1e-6F);
  EXPECT_EQ(at(*strip, 40, kTableNear), 1);
}

TEST(Strip, ARopeInTheAirHasNoWayToATable) {
  const StraightRope rope;
  auto curve = arched(rope, 0, 55);
  curve.unseen_m.fill(0);
  const auto strip = strip_along(curve, rope.frame());
  ASSERT_TRUE(strip);
  for (const float share : strip->table_share) EXPECT_EQ(share, 1);
  EXPECT_LT(at(*strip, 128, kTableNear), 0.25F);
  EXPECT_GT(at(*strip, 128, kTable), 1);  // it is told all the same
}

TEST(Strip, SaysWhatLiesBesideTheRope) {
  const StraightRope rope;
  const auto strip = strip_along(rope.curve(), rope.frame());
  ASSERT_TRUE(strip);
  EXPECT_NEAR(at(*strip, 128, kGround), std::asinh(1.0F) / 2, 0.01F);  // a radius deeper
  EXPECT_EQ(at(*strip, 128, kGroundSides), 1);
}

TEST(Strip, NoTableWhereNothingIsSeenBesideTheRope) {
  StraightRope rope;
  const auto mask = rope.frame().mask;
  for (std::size_t i = 0; i < rope.depth_m().size(); ++i) {
    if (mask[i] == 0) rope.depth_m()[i] = 0;
  }
  const auto strip = strip_along(rope.curve(), rope.frame());
  ASSERT_TRUE(strip);
  for (const float share : strip->table_share) EXPECT_EQ(share, 1);
  for (int column = kTable; column < kColumnsUsed; ++column) {
    EXPECT_EQ(at(*strip, 128, column), 0) << column;
  }
  EXPECT_EQ(at(*strip, 128, kGroundSides), 0);
}

TEST(Strip, HostileDepthLeavesNothingThatIsNotFinite) {
  StraightRope rope;
  const float hostile[] = {std::numeric_limits<float>::quiet_NaN(),
                           std::numeric_limits<float>::infinity(),
                           -std::numeric_limits<float>::infinity(),
                           -1,
                           0,
                           1e30F};
  for (std::size_t i = 0; i < rope.depth_m().size(); ++i) rope.depth_m()[i] = hostile[i % 6];
  const auto strip = strip_along(rope.curve(), rope.frame());
  ASSERT_TRUE(strip);
  for (const float value : strip->values) ASSERT_TRUE(std::isfinite(value));
  EXPECT_EQ(at(*strip, 128, kMeasured * kAcross + 7), 0);
}

TEST(Strip, NoneOfACurveBehindTheCameraOrWithoutWidth) {
  const StraightRope rope;
  auto curve = rope.curve();
  curve.nodes[5].z = -0.1F;
  EXPECT_FALSE(strip_along(curve, rope.frame()));
  curve = rope.curve();
  curve.nodes[5].x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(strip_along(curve, rope.frame()));
  curve = rope.curve();
  curve.radius_m = 0;
  EXPECT_FALSE(strip_along(curve, rope.frame()));
}

TEST(Strip, NodesThatAllLieOnOnePointMakeAFiniteOne) {
  const StraightRope rope;
  auto curve = rope.curve();
  curve.nodes.fill(curve.nodes[20]);
  const auto strip = strip_along(curve, rope.frame());
  ASSERT_TRUE(strip);
  for (const float value : strip->values) ASSERT_TRUE(std::isfinite(value));
}

}  // namespace
}  // namespace flowdlo::refine
