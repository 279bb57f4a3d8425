#include "recording/stamp_match.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flowdlo::recording {
namespace {

using testing::ElementsAre;
using testing::Eq;
using testing::Optional;

using Stamps = std::vector<std::int64_t>;

TEST(StampMatch, PairsTheNearest) {
  const auto partners = match_stamps(Stamps{0, 100, 200}, Stamps{4, 97, 205}, 20);
  EXPECT_THAT(partners, ElementsAre(Optional(Eq(0U)), Optional(Eq(1U)), Optional(Eq(2U))));
}

TEST(StampMatch, ToleranceIsInclusive) {
  EXPECT_TRUE(match_stamps(Stamps{100}, Stamps{120}, 20)[0].has_value());
  EXPECT_TRUE(match_stamps(Stamps{100}, Stamps{80}, 20)[0].has_value());
  EXPECT_FALSE(match_stamps(Stamps{100}, Stamps{121}, 20)[0].has_value());
  EXPECT_FALSE(match_stamps(Stamps{100}, Stamps{79}, 20)[0].has_value());
}

TEST(StampMatch, LostMessageLeavesItsPartnerAlone) {
  // The second colour image was lost: its depth must not take that of a neighbour.
  const auto partners = match_stamps(Stamps{0, 30, 60}, Stamps{1, 61}, 40);
  EXPECT_THAT(partners, ElementsAre(Optional(Eq(0U)), Eq(std::nullopt), Optional(Eq(1U))));
}

TEST(StampMatch, MessageHasOnePartnerOnly) {
  const auto partners = match_stamps(Stamps{90, 100, 110}, Stamps{101}, 20);
  EXPECT_THAT(partners, ElementsAre(Eq(std::nullopt), Optional(Eq(0U)), Eq(std::nullopt)));
}

TEST(StampMatch, OrderOfArrivalDoesNotMatter) {
  const auto partners = match_stamps(Stamps{200, 0, 100}, Stamps{97, 205, 4}, 20);
  EXPECT_THAT(partners, ElementsAre(Optional(Eq(1U)), Optional(Eq(2U)), Optional(Eq(0U))));
}

TEST(StampMatch, OfTwoEquallyNearTheEarlierCounts) {
  EXPECT_THAT(match_stamps(Stamps{100}, Stamps{110, 90}, 20), ElementsAre(Optional(Eq(1U))));
  EXPECT_THAT(match_stamps(Stamps{100, 100}, Stamps{100}, 20),
              ElementsAre(Optional(Eq(0U)), Eq(std::nullopt)));
}

TEST(StampMatch, NothingMatchesNothing) {
  EXPECT_TRUE(match_stamps({}, Stamps{1}, 20).empty());
  EXPECT_THAT(match_stamps(Stamps{1}, {}, 20), ElementsAre(Eq(std::nullopt)));
}

TEST(StampMatch, CameraInfoHoldsUntilTheNext) {
  const Stamps infos{100, 200, 300};
  EXPECT_EQ(latest_until(infos, 250), 1U);
  EXPECT_EQ(latest_until(infos, 300), 2U);
  EXPECT_EQ(latest_until(infos, 50), 0U) << "the first one, where all are later";
}

}  // namespace
}  // namespace flowdlo::recording
