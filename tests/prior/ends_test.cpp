#include "prior/ends.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "prior/sheet.hpp"

namespace flowdlo::prior {
namespace {

using testing::Points;
using testing::Sheet;
using testing::strip_of;

TEST(ToTheTips, ReachesTheMasksTips) {
  const Sheet sheet = Sheet().box(20, 115, 300, 125);
  const Points points = to_the_tips(Points{{40, 120}, {285, 120}}, 11, sheet.frame());
  EXPECT_NEAR(points.front().x(), 19.5, 0.6);
  EXPECT_NEAR(points.back().x(), 300.5, 0.6);
}

TEST(ToTheTips, FollowsAMaskThatBendsAtItsTip) {
  const Sheet sheet = Sheet().box(20, 115, 200, 125).box(190, 80, 200, 125);
  const Points points = to_the_tips(Points{{20, 120}, {188, 120}, {195, 112}}, 11, sheet.frame());
  EXPECT_NEAR(points.back().x(), 195, 2);
  EXPECT_NEAR(points.back().y(), 79.5, 1);
}

TEST(ToTheTips, DoesNotRunAroundARingTwice) {
  Sheet sheet;
  Points ring;
  for (int a = 0; a <= 200; ++a) {
    const float angle = 6.2832F * static_cast<float>(a) / 200;
    ring.emplace_back(160 + 80 * std::cos(angle), 120 + 80 * std::sin(angle));
    const auto u = static_cast<int>(ring.back().x());
    const auto v = static_cast<int>(ring.back().y());
    sheet.box(u - 4, v - 4, u + 4, v + 4);
  }
  const Points points = to_the_tips(ring, 9, sheet.frame());
  EXPECT_LT((points.front() - ring.front()).norm(), 9);
  EXPECT_LT((points.back() - ring.back()).norm(), 9);
}

TEST(WithoutCaps, TakesHalfAWidthOffARoundTip) {
  Sheet sheet = Sheet().box(40, 115, 280, 125);
  for (int v = 115; v <= 125; ++v) {  // half discs of 5.5 px at both ends
    const int reach =
        static_cast<int>(std::sqrt(30.25F - static_cast<float>((v - 120) * (v - 120))));
    sheet.box(40 - reach, v, 280 + reach, v);
  }
  const Strip strip = strip_of(Points{{34.6F, 120}, {285.4F, 120}}, 11, sheet);
  const Extent extent = without_caps(strip, sheet.frame());
  EXPECT_NEAR(extent.begin_px, 5.4, 0.7);
  EXPECT_NEAR(strip.stations.back().arclength_px - extent.end_px, 5.4, 0.7);
}

TEST(WithoutCaps, TakesNothingOffASquareTip) {
  const Sheet sheet = Sheet().box(20, 115, 300, 125);
  const Strip strip = strip_of(Points{{19.6F, 120}, {300.4F, 120}}, 11, sheet);
  const Extent extent = without_caps(strip, sheet.frame());
  EXPECT_EQ(extent.begin_px, 0);
  EXPECT_EQ(extent.end_px, strip.stations.back().arclength_px);
  EXPECT_TRUE(extent.tip[0] && extent.tip[1]);
}

TEST(WithoutCaps, TakesNothingOffWhereTheMaskGoesOn) {
  const Sheet sheet = Sheet().box(20, 115, 300, 125);
  const Strip strip = strip_of(Points{{100, 120}, {200, 120}}, 11, sheet);
  const Extent extent = without_caps(strip, sheet.frame());
  EXPECT_EQ(extent.begin_px, 0);
  EXPECT_EQ(extent.end_px, strip.stations.back().arclength_px);
  EXPECT_FALSE(extent.tip[0] || extent.tip[1]);
}

}  // namespace
}  // namespace flowdlo::prior
