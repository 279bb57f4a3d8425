#include "track/alignment.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "track/curves.hpp"

namespace flowdlo::track {
namespace {

using testing::backwards;
using testing::ring;
using testing::rope;
using testing::straight;

TEST(Alignment, ARopeAsItWasStaysAsItIs) {
  const Alignment same = align(straight(0, 0.01F), false, straight(0, 0));
  EXPECT_EQ(same.from.front(), 0U);
  EXPECT_FALSE(same.reversed);
  EXPECT_NEAR(same.apart_m, 0.01, 1e-6);
}

TEST(Alignment, ARopeFromItsOtherEndIsReversed) {
  const Centerline known = straight(0, 0);
  Estimate found = rope(backwards(known));
  const Alignment other = align(found.nodes, false, known);
  EXPECT_TRUE(other.reversed);
  EXPECT_NEAR(other.apart_m, 0, 1e-6);
  turn(found, other, known);
  EXPECT_EQ(found.nodes, known);
  EXPECT_EQ(found.support.front(), kNodes - 1);
  EXPECT_EQ(found.sigma_m.back(), 0);
  EXPECT_TRUE(found.reversed);
}

TEST(Alignment, ARopeWithTwoEndsBeginsAtOneOfThem) {
  Centerline known = straight(0, 0);
  for (auto& node : known) node.x += 0.1F;  // a rotation would fit it better
  EXPECT_EQ(align(straight(0, 0), false, known).from.front(), 0U);
}

TEST(Alignment, ARingBeginsWhereItDid) {
  const Centerline known = ring(0);
  for (const bool reversed : {false, true}) {
    Estimate found = rope(ring(1.0 / 3), true);
    if (reversed) std::reverse(found.nodes.begin(), found.nodes.end());
    const Alignment alignment = align(found.nodes, true, known);
    EXPECT_EQ(alignment.reversed, reversed);
    turn(found, alignment, known);
    for (std::size_t i = 0; i < kNodes; ++i) {
      EXPECT_NEAR(found.nodes[i].x, known[i].x, 1e-5) << i;
      EXPECT_NEAR(found.nodes[i].y, known[i].y, 1e-5) << i;
    }
    EXPECT_EQ(found.nodes.front(), found.nodes.back()) << "it is closed wherever it begins";
    EXPECT_EQ(found.support.front(), reversed ? 21 : 42);
  }
}

TEST(Alignment, EachAlternativeIsTurnedForItself) {
  const Centerline known = straight(0, 0);
  Estimate found = rope(known);
  found.alternatives = {{.nodes = backwards(straight(0, 0.02F))}, {.nodes = straight(0, 0.03F)}};
  turn(found, align(found.nodes, false, known), known);
  EXPECT_EQ(found.alternatives[0].nodes, straight(0, 0.02F));
  EXPECT_EQ(found.alternatives[1].nodes, straight(0, 0.03F));
  EXPECT_FALSE(found.reversed);
}

TEST(Alignment, NodesThatAreNotFiniteChangeNothing) {
  Centerline broken = straight(0, 0);
  broken[7].x = std::numeric_limits<float>::quiet_NaN();
  const Alignment alignment = align(broken, true, straight(0, 0));
  EXPECT_EQ(alignment.from.front(), 0U);
  EXPECT_EQ(alignment.from.back(), kNodes - 1);
  EXPECT_FALSE(alignment.reversed);
}

TEST(Alignment, APlaceOnTheRopeIsToldFromWhereItNowBegins) {
  const Centerline nodes = straight(0, 0);
  EXPECT_NEAR(turned_m(0.1, nodes, false, {}), 0.1, 1e-6);
  EXPECT_NEAR(turned_m(0.1, nodes, false, {.reversed = true}), 0.4, 1e-6);
}

TEST(Alignment, APlaceOnARingIsToldRoundIt) {
  const Centerline nodes = ring(0);
  constexpr int kSteps = kNodes - 1;
  const double step_m = 2 * 0.2 * std::sin(3.14159265 / kSteps);
  const double start = 3.0 / kSteps;
  const Alignment on{.begins = start};
  const Alignment back{.reversed = true, .begins = start};
  EXPECT_NEAR(turned_m(5 * step_m, nodes, true, on), 2 * step_m, 1e-5);
  EXPECT_NEAR(turned_m(1 * step_m, nodes, true, on), (kSteps - 2) * step_m, 1e-5);
  EXPECT_NEAR(turned_m(1 * step_m, nodes, true, back), 2 * step_m, 1e-5);
  EXPECT_NEAR(turned_m(5 * step_m, nodes, true, back), (kSteps - 2) * step_m, 1e-5);
}

}  // namespace
}  // namespace flowdlo::track
