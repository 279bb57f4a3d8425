#include "path/region.hpp"

#include <gtest/gtest.h>

#include "canvas.hpp"

namespace flowdlo::test {
namespace {

std::uint8_t at(const path::Region& region, int u, int v) {
  return region.mask.at(v - region.offset_px.y, u - region.offset_px.x);
}

TEST(Region, IsAsLargeAsTheMasksBoundingBox) {
  const Canvas canvas = Canvas().stroke({{200, 150}, {300, 150}}, 9);
  const auto region = path::clean(canvas.frame());
  ASSERT_TRUE(region);
  EXPECT_LT(region->mask.width(), 120);
  EXPECT_LT(region->mask.height(), 20);
  EXPECT_EQ(at(*region, 250, 150), 1);
}

TEST(Region, KnowsTheRopesWidth) {
  for (const int width : {3, 7, 12, 25, 60}) {
    const Canvas canvas = Canvas().stroke({{100, 150}, {500, 330}}, width);
    const auto region = path::clean(canvas.frame());
    ASSERT_TRUE(region);
    EXPECT_NEAR(region->width_px, width, 2.6 + 0.1 * width);
  }
}

TEST(Region, FillsAHighlightInsideAStrand) {
  Canvas canvas = Canvas().stroke({{100, 200}, {500, 200}}, 15);
  canvas.erase({250, 198, 40, 4});
  const auto region = path::clean(canvas.frame());
  ASSERT_TRUE(region);
  EXPECT_EQ(at(*region, 270, 200), 1);
}

TEST(Region, KeepsTheNarrowHoleOfALoop) {
  Canvas canvas =
      Canvas().stroke({{100, 200}, {500, 200}}, 12).stroke({{100, 216}, {500, 216}}, 12);
  canvas.stroke({{100, 208}, {140, 208}}, 12).stroke({{460, 208}, {500, 208}}, 12);
  const auto region = path::clean(canvas.frame());
  ASSERT_TRUE(region);
  EXPECT_EQ(at(*region, 300, 208), 0) << "two strands beside each other, not a highlight";
}

// A strand 13 px thick along v = 200; slivers 3 px thick beside it, a dark pixel between them.
Canvas fringed() {
  Canvas canvas;
  canvas.mask(cv::Rect{100, 194, 400, 13}) = 255;
  for (int u = 120; u < 480; u += 24) {
    canvas.mask(cv::Rect{u, 208, 14, 3}) = 255;
    canvas.mask(cv::Rect{u + 9, 190, 14, 3}) = 255;
  }
  return canvas;
}

TEST(Region, ErasesAFringeBehindADarkLine) {
  const auto region = path::clean(fringed().frame());
  ASSERT_TRUE(region);
  EXPECT_EQ(at(*region, 125, 209), 0);
  EXPECT_EQ(at(*region, 250, 200), 1);
  EXPECT_NEAR(region->width_px, 13, 2);
}

TEST(Region, KeepsEquallyThickStrandsAPixelApart) {
  const Canvas canvas =
      Canvas().stroke({{100, 200}, {500, 200}}, 7).stroke({{100, 208}, {300, 208}}, 7);
  const auto region = path::clean(canvas.frame());
  ASSERT_TRUE(region);
  EXPECT_EQ(at(*region, 200, 200), 1);
  EXPECT_EQ(at(*region, 200, 208), 1);
}

TEST(Region, RejectsPiecesFarSmallerThanTheRopeIsWide) {
  Canvas canvas = Canvas().stroke({{100, 200}, {500, 200}}, 20);
  canvas.mask(cv::Rect{300, 300, 8, 8}) = 255;
  const auto region = path::clean(canvas.frame());
  ASSERT_TRUE(region);
  EXPECT_EQ(at(*region, 303, 303), 0);
}

}  // namespace
}  // namespace flowdlo::test
