#include "prior/strip.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "prior/sheet.hpp"

namespace flowdlo::prior {
namespace {

using testing::kCross;
using testing::kHeight;
using testing::kLevel;
using testing::kWidth;
using testing::Points;
using testing::Sheet;
using testing::strip_of;

TEST(MakeStrip, ReadsTheMasksEdgesBesideThePath) {
  const Sheet sheet = Sheet().box(20, 115, 300, 125);
  const Strip strip = strip_of(kLevel, 11, sheet);
  const Station& middle = strip.stations[strip.stations.size() / 2];
  EXPECT_TRUE(middle.masked && middle.bounded);
  EXPECT_NEAR(middle.left_px, 5.5, 0.3);  // to the pixels' outer edges
  EXPECT_NEAR(middle.right_px, 5.5, 0.3);
  EXPECT_NEAR(middle.aside, 1.0 / 300, 1e-5);
}

TEST(MakeStrip, ReadsDepthsWithinHalfAWidthOfThePath) {
  const Sheet sheet = Sheet().box(20, 115, 300, 125).box(150, 100, 170, 140);
  const Strip strip = strip_of(kLevel, 11, sheet);
  ASSERT_FALSE(strip.readings.empty());
  for (const Reading& reading : strip.readings) {
    EXPECT_LE(std::abs(reading.offset_px), 6);
    EXPECT_FLOAT_EQ(reading.depth_m, 0.5F);
    EXPECT_EQ(reading.rival, -1);
  }
}

TEST(MakeStrip, ReadsNothingOffTheMaskOrWithoutDepth) {
  Sheet sheet = Sheet().box(20, 115, 150, 125);
  for (int u = 20; u < 80; ++u) {
    for (int v = 0; v < kHeight; ++v) sheet.depth_m[static_cast<std::size_t>(v * kWidth + u)] = 0;
  }
  const Strip strip = strip_of(kLevel, 11, sheet);
  for (const Reading& reading : strip.readings) {
    const float u = strip.stations[static_cast<std::size_t>(reading.station)].point_px.x();
    EXPECT_GE(u, 79);
    EXPECT_LE(u, 151);
  }
  EXPECT_FALSE(strip.stations.back().masked);
}

TEST(MakeStrip, ReadsEveryPixelOfASparseCloud) {
  Sheet sheet = Sheet().box(20, 115, 300, 125);
  const auto full = sheet.depth_m;
  std::fill(sheet.depth_m.begin(), sheet.depth_m.end(), 0.0F);
  for (int k = 0; k < 40; ++k) {
    const auto pixel = static_cast<std::size_t>((115 + k % 11) * kWidth + 40 + 6 * k);
    sheet.depth_m[pixel] = full[pixel];
  }
  EXPECT_EQ(strip_of(kLevel, 11, sheet).readings.size(), 40U);
}

TEST(MakeStrip, FindsTheMaskBesideAPathThatIsALittleOff) {
  const Sheet sheet = Sheet().box(20, 117, 300, 122);  // the axis is 2.5 px beside the mask
  const Strip strip = strip_of(Points{{20, 125}, {300, 125}}, 11, sheet);
  EXPECT_TRUE(strip.stations[100].masked);
}

TEST(MakeStrip, KnowsWhichPixelsTwoStrandsShare) {
  const Sheet sheet = Sheet()
                          .box(40, 115, 285, 125)
                          .box(275, 25, 285, 125)
                          .box(155, 25, 285, 35)
                          .box(155, 25, 165, 220);
  const Strip strip = strip_of(kCross, 11, sheet);
  int shared = 0;
  for (const Reading& reading : strip.readings) {
    const Station& at = strip.stations[static_cast<std::size_t>(reading.station)];
    const Eigen::Vector2f p = at.point_px + reading.offset_px * at.normal;
    const bool inside = std::abs(p.x() - 160) < 5 && std::abs(p.y() - 120) < 5;
    const bool outside = std::abs(p.x() - 160) > 8 || std::abs(p.y() - 120) > 8;
    EXPECT_TRUE(!inside || reading.rival >= 0) << p.transpose();
    EXPECT_TRUE(!outside || reading.rival == -1) << p.transpose();
    shared += reading.rival >= 0 ? 1 : 0;
  }
  EXPECT_GT(shared, 100);
}

}  // namespace
}  // namespace flowdlo::prior
