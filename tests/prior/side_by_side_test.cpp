#include "prior/side_by_side.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>

#include "prior/sheet.hpp"

namespace flowdlo::prior {
namespace {

using testing::kCross;
using testing::Points;
using testing::Sheet;
using testing::strip_of;

/// A hairpin: strands 11 px wide at v = 115 and 126 touch from u = 60 to 200; beyond they part.
struct Hairpin {
  Sheet sheet;
  Points truth;
  Points path;

  Hairpin() {
    for (int u = 10; u <= 280; ++u) {
      const float away = static_cast<float>(u < 90 ? 90 - u : std::max(0, u - 200));
      const float apart = 0.15F * away;
      const int up = static_cast<int>(115 - apart);
      const int down = static_cast<int>(126 + apart);
      sheet.box(u, up - 5, u, up + 5).box(u, down - 5, u, down + 5);
      truth.emplace_back(u, 115 - apart);
    }
    sheet.box(270, 98, 285, 143);
    const std::size_t half = truth.size();
    for (int v = 106; v < 136; ++v) truth.emplace_back(280, v);
    for (std::size_t i = half; i-- > 0;) truth.emplace_back(truth[i].x(), 241 - truth[i].y());
    path = truth;
    for (auto& p : path) {  // in the middle both strands lie on the seam
      const float in = std::min(p.x() - 80, 210 - p.x());
      const float share = std::clamp(in / 30, 0.0F, 1.0F);
      p.y() += share * (120.5F - p.y());
    }
  }
};

TEST(SideBySide, PutsTouchingStrandsOnTheirOwnHalvesOfTheMask) {
  const Hairpin hairpin;
  const Strip strip = strip_of(hairpin.path, 11, hairpin.sheet);
  const auto moved = side_by_side(strip);
  ASSERT_TRUE(moved.has_value());
  int upper = 0;
  int lower = 0;
  for (const auto& p : *moved) {
    if (p.x() < 80 || p.x() > 180) continue;
    const bool up = p.y() < 120.5F;
    EXPECT_NEAR(p.y(), up ? 115 : 126, 1.5) << "u = " << p.x();
    ++(up ? upper : lower);
  }
  EXPECT_NEAR(upper, lower, 5);
}

TEST(SideBySide, LeavesARealCrossingAlone) {
  const Sheet sheet = Sheet().box(40, 115, 285, 125).box(155, 25, 165, 220);
  EXPECT_FALSE(side_by_side(strip_of(kCross, 11, sheet)).has_value());
}

TEST(SideBySide, LeavesTheMiddleOfThreeStrandsBesideTheOneItMergesWith) {
  Sheet sheet;  // strands 11 px wide; a slit above the middle one, none below it
  sheet.box(40, 99, 240, 109).box(40, 111, 240, 132);
  Points path;
  for (int u = 40; u <= 240; ++u) path.emplace_back(u, 104);
  for (int v = 105; v < 115; ++v) path.emplace_back(250, v);
  for (int u = 240; u >= 40; --u) path.emplace_back(u, 115);
  for (int v = 116; v < 127; ++v) path.emplace_back(30, v);
  for (int u = 40; u <= 240; ++u) path.emplace_back(u, 127);
  const Strip strip = strip_of(path, 11, sheet);
  const auto moved = side_by_side(strip);
  if (!moved) return;  // nothing to move is as good
  for (std::size_t i = 0; i < strip.stations.size(); ++i) {
    const auto& before = strip.stations[i].point_px;
    if (before.x() < 80 || before.x() > 200) continue;
    EXPECT_NEAR((*moved)[i].y(), before.y(), 2) << "u = " << before.x();
  }
}

}  // namespace
}  // namespace flowdlo::prior
