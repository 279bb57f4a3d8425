#include "refine/strip.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/straight_rope.hpp"

namespace flowdlo::refine {
namespace {

using testing::StraightRope;

float at(const Strip& strip, int station, int column) {
  return strip.values[static_cast<std::size_t>(station * weights::kRefineInputs + column)];
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
