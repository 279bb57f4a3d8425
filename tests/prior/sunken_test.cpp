#include "prior/sunken.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>

#include "drawn_rope.hpp"
#include "prior/strip.hpp"

namespace flowdlo::prior {
namespace {

using testing::draw_rope;
using testing::DrawnRope;
using testing::straight_line;

constexpr float kWall_m = 2.0F;

/// Depth of the mask's pixels from column `first` to `last`, and of the wall behind them.
void repaint(DrawnRope& rope, int first, int last, float rope_m, float wall_m = kWall_m) {
  for (int v = 0; v < rope.image.height; ++v) {
    for (int u = first; u <= last; ++u) {
      const std::size_t at = rope.index(u, v);
      rope.image.depth_m[at] = rope.image.mask[at] > 127 ? rope_m : wall_m;
    }
  }
}

Strip dropped(const DrawnRope& rope) {
  const Frame frame = rope.frame();
  Strip strip = make_strip(rope.path.points_px, rope.width_px, frame, evidence::unproject(frame));
  drop_sunken(strip);
  return strip;
}

int readings_between(const Strip& strip, float first_u, float last_u) {
  int count = 0;
  for (const Reading& reading : strip.readings) {
    const float u = strip.stations[static_cast<std::size_t>(reading.station)].point_px.x();
    count += u > first_u && u < last_u ? 1 : 0;
  }
  return count;
}

TEST(Sunken, AStretchAtTheWallsDepthIsDroppedAndTheRestKept) {
  DrawnRope rope = draw_rope(straight_line());
  repaint(rope, 250, 400, 1.86F);
  const Strip strip = dropped(rope);
  EXPECT_EQ(readings_between(strip, 256, 394), 0);
  EXPECT_GT(readings_between(strip, 130, 240), 500);
  EXPECT_GT(readings_between(strip, 410, 510), 500);
}

TEST(Sunken, AStretchIsDroppedWholeThoughFlyingPixelsPartIt) {
  DrawnRope rope = draw_rope(straight_line());
  repaint(rope, 250, 400, 1.86F);
  repaint(rope, 300, 306, 1.2F);
  repaint(rope, 340, 346, 1.6F);
  const Strip strip = dropped(rope);
  EXPECT_EQ(readings_between(strip, 256, 394), 0);
  EXPECT_GT(readings_between(strip, 130, 240), 500);
  EXPECT_GT(readings_between(strip, 410, 510), 500);
}

TEST(Sunken, AStretchBehindAHoleOrBeyondTheWallIsDropped) {
  DrawnRope rope = draw_rope(straight_line());
  repaint(rope, 200, 249, 0);
  repaint(rope, 250, 400, kWall_m + 0.02F);
  EXPECT_EQ(readings_between(dropped(rope), 256, 394), 0);
}

TEST(Sunken, ARopeThatComesNearerAllTheWayIsKept) {
  DrawnRope rope = draw_rope(straight_line());
  for (int u = 0; u < 640; ++u) repaint(rope, u, u, 1.9F - 0.0025F * static_cast<float>(u));
  EXPECT_GT(readings_between(dropped(rope), 130, 240), 500);
  EXPECT_GT(readings_between(dropped(rope), 410, 510), 500);
}

// Lies on a plane seen at a grazing angle: 1 / z falls evenly along the image.
TEST(Sunken, ARopeThatRunsAwaySteeplyIsKept) {
  DrawnRope rope = draw_rope(straight_line());
  for (int u = 0; u < 640; ++u) {
    const float away = std::max(0.0F, static_cast<float>(u) - 300.0F);
    const float rope_m = 1 / (1 / 0.4F - 0.009F * away);
    repaint(rope, u, u, rope_m, u < 300 ? kWall_m : rope_m + 0.05F);
  }
  repaint(rope, 400, 440, 0, 0);
  EXPECT_GT(readings_between(dropped(rope), 130, 240), 500);
  EXPECT_GT(readings_between(dropped(rope), 445, 510), 300);
}

TEST(Sunken, ThePriorBridgesTheStretch) {
  DrawnRope rope = draw_rope(straight_line());
  repaint(rope, 250, 400, 1.86F);
  const auto prior = rope.refined();
  ASSERT_TRUE(prior);
  for (const Point3& node : prior->nodes) EXPECT_NEAR(node.z, 0.6F, 0.004F);
}

TEST(Sunken, ARopeOnTheWallWithSomethingBeforeItIsKept) {
  DrawnRope rope = draw_rope(straight_line());
  repaint(rope, 0, 639, 0.6F, 0.608F);
  repaint(rope, 250, 290, 0.4F, 0.608F);
  EXPECT_GT(readings_between(dropped(rope), 130, 240), 500);
  EXPECT_GT(readings_between(dropped(rope), 300, 500), 500);
}

}  // namespace
}  // namespace flowdlo::prior
