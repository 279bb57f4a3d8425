#include "reports/rope_identity.hpp"

#include <gtest/gtest.h>

#include "track/curves.hpp"

namespace flowdlo::lab {
namespace {

using flowdlo::testing::backwards;
using flowdlo::testing::ring;
using flowdlo::testing::rope;
using flowdlo::testing::straight;

const Centerline kFirst = straight(0, 0);
const Centerline kSecond = straight(0, 0.1F);

TEST(RopeIdentity, CountsNothingWhereRopesStayAndAreRight) {
  RopeIdentity identity;
  for (int frame = 0; frame < 3; ++frame) {
    identity.add({rope(kFirst), rope(kSecond)}, {0, 1}, {kFirst, kSecond});
  }
  EXPECT_EQ(identity.ropes, 6);
  EXPECT_EQ(identity.mistaken + identity.exchanged + identity.begun, 0);
  EXPECT_EQ(identity.jumped + identity.wrong, 0);
}

TEST(RopeIdentity, CountsRopesThatExchangeTheirNumbers) {
  RopeIdentity identity;
  identity.add({rope(kFirst), rope(kSecond)}, {0, 1}, {kFirst, kSecond});
  identity.add({rope(kSecond), rope(kFirst)}, {0, 1}, {kFirst, kSecond});
  EXPECT_EQ(identity.mistaken, 2);
  EXPECT_EQ(identity.jumped, 0);
  identity.add({rope(kSecond), rope(kFirst)}, {0, 1}, {kFirst, kSecond});
  EXPECT_EQ(identity.mistaken, 2) << "a frame is held against the one before it";
}

TEST(RopeIdentity, CountsARopeThatIsToldFromItsOtherEnd) {
  RopeIdentity identity;
  identity.add({rope(kFirst)}, {0}, {kFirst});
  identity.add({rope(backwards(kFirst))}, {0}, {kFirst});
  EXPECT_EQ(identity.exchanged, 1);
  EXPECT_EQ(identity.wrong, 0) << "which end comes first is no matter of the truth";
}

TEST(RopeIdentity, CountsARopeThatLiesElsewhere) {
  RopeIdentity identity;
  identity.add({rope(kFirst)}, {0}, {kFirst});
  identity.add({rope(kSecond)}, {0}, {kFirst});
  EXPECT_EQ(identity.jumped, 1);
  EXPECT_EQ(identity.wrong, 1);
}

TEST(RopeIdentity, CountsARingThatBeginsElsewhere) {
  RopeIdentity identity;
  identity.add({rope(ring(0), true)}, {0}, {ring(0)});
  identity.add({rope(ring(1.0 / 3), true)}, {0}, {ring(0)});
  EXPECT_EQ(identity.begun, 1);
  EXPECT_EQ(identity.jumped, 0);
  EXPECT_EQ(identity.exchanged, 0);
}

TEST(RopeIdentity, AddsUpScenes) {
  RopeIdentity one;
  one.add({rope(kFirst)}, {0}, {kFirst});
  one.add({rope(kSecond)}, {1}, {kFirst});
  RopeIdentity both = one;
  both.add(one);
  EXPECT_EQ(both.ropes, 4);
  EXPECT_EQ(both.mistaken, 2);
  EXPECT_EQ(both.jumped, 2);
  EXPECT_EQ(both.wrong, 2);
}

}  // namespace
}  // namespace flowdlo::lab
