#include "prior/contacts.hpp"

#include <gtest/gtest.h>

#include "prior/sheet.hpp"

namespace flowdlo::prior {
namespace {

using testing::kCross;
using testing::kLevel;
using testing::Sheet;
using testing::strip_of;

TEST(FindContacts, FindsTheStretchesThatCross) {
  const Sheet sheet = Sheet().box(40, 115, 285, 125).box(155, 25, 165, 220);
  const Strip strip = strip_of(kCross, 11, sheet);
  const auto contacts = find_contacts(strip);
  ASSERT_EQ(contacts.size(), 1U);
  const auto middle = [&](const Stretch& stretch) {
    return strip.stations[static_cast<std::size_t>((stretch.first + stretch.last) / 2)].point_px;
  };
  EXPECT_LT((middle(contacts[0].early) - Eigen::Vector2f(160, 120)).norm(), 3);
  EXPECT_LT((middle(contacts[0].late) - Eigen::Vector2f(160, 120)).norm(), 3);
}

TEST(FindContacts, FindsNoneOnAStraightRope) {
  const Sheet sheet = Sheet().box(20, 115, 300, 125);
  EXPECT_TRUE(find_contacts(strip_of(kLevel, 11, sheet)).empty());
}

}  // namespace
}  // namespace flowdlo::prior
