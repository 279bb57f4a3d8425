#include "field/region.hpp"

#include <gtest/gtest.h>

namespace flowdlo::field {
namespace {

const image::Size kFrame{640, 480};

TEST(Region, RopeIsEightPixelsWide) {
  const Region region = region_around({200, 150, 100, 80}, kFrame, 4);
  EXPECT_NEAR(region.scale.x(), 2, 0.02F);
  EXPECT_NEAR(region.scale.y(), 2, 0.02F);
}

TEST(Region, HoldsTheMaskAndThreeWidthsAround) {
  const Region region = region_around({200, 150, 100, 80}, kFrame, 4);
  EXPECT_EQ(region.box, (image::Rect{184, 134, 132, 112}));
}

TEST(Region, EndsWithTheImage) {
  const Region region = region_around({0, 470, 640, 10}, kFrame, 20);
  EXPECT_EQ(region.box, (image::Rect{0, 406, 640, 74}));
}

TEST(Region, AHairIsMagnifiedFourTimesAndNoMore) {
  EXPECT_NEAR(region_around({200, 150, 100, 80}, kFrame, 1).scale.x(), kMostScale, 0.05F);
}

TEST(Region, AVeryWideRopeLeavesARegionThatCanBeSeen) {
  const Region region = region_around({300, 200, 8, 8}, kFrame, 400);
  EXPECT_GE(region.size.width, 16);
  EXPECT_GE(region.size.height, 16);
}

TEST(Region, PlacesGoThereAndBack) {
  const Region region = region_around({200, 150, 101, 83}, kFrame, 5);
  for (const Eigen::Vector2f& px : {Eigen::Vector2f(200, 150), Eigen::Vector2f(260.5F, 199.25F)}) {
    EXPECT_LT((region.to_frame(region.to_region(px)) - px).norm(), 1e-3F);
  }
}

TEST(Region, CornersOfPixelsMeetCornersOfPixels) {
  const Region region = region_around({200, 150, 100, 80}, kFrame, 4);
  const Eigen::Vector2f corner(static_cast<float>(region.box.x) - 0.5F,
                               static_cast<float>(region.box.y) - 0.5F);
  EXPECT_LT((region.to_region(corner) - Eigen::Vector2f(-0.5F, -0.5F)).norm(), 1e-4F);
}

}  // namespace
}  // namespace flowdlo::field
