#include "field/block_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flowdlo::field {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

/// A mask of a square spot around the corner of four pixels, which covers so much of each.
image::Image<float> spot(int width, int height, int u, int v, int side = 20, float share = 1) {
  image::Image<float> mask({width, height}, 0.0F);
  mask.part({u - side / 2, v - side / 2, side, side}).fill(share);
  return mask;
}

TEST(BlockMap, EmptyMaskNeedsNoBlock) {
  EXPECT_TRUE(blocks_near(image::Image<float>({200, 100}, 0.0F)).blocks.empty());
}

TEST(BlockMap, BlocksWithinAWidthOfTheMaskAreComputed) {
  const BlockMap map = blocks_near(spot(320, 96, 48, 48));  // the middle of a block
  EXPECT_EQ(map.columns, 10);
  EXPECT_EQ(map.rows, 3);
  EXPECT_THAT(map.blocks, ElementsAre(image::Point{0, 0}, image::Point{1, 0}, image::Point{2, 0},
                                      image::Point{0, 1}, image::Point{1, 1}, image::Point{2, 1},
                                      image::Point{0, 2}, image::Point{1, 2}, image::Point{2, 2}));
  EXPECT_THAT(blocks_near(spot(320, 96, 48, 48, 14)).blocks, ElementsAre(image::Point{1, 1}));
}

TEST(BlockMap, HalfAPixelIsNoMask) {
  EXPECT_TRUE(blocks_near(spot(320, 96, 48, 48, 20, 0.5F)).blocks.empty());
}

TEST(BlockMap, KnowsWhatLiesAround) {
  const BlockMap map = blocks_near(spot(320, 96, 48, 48));
  EXPECT_THAT(map.around(4), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8));
  EXPECT_THAT(map.around(0), ElementsAre(-1, -1, -1, -1, 0, 1, -1, 3, 4));
  EXPECT_THAT(map.around(5), ElementsAre(1, 2, -1, 4, 5, -1, 7, 8, -1));
}

TEST(BlockMap, CutKeepsPlacesAndNumbersAnew) {
  const BlockMap map = cut(blocks_near(spot(320, 96, 48, 48)), {1, 0, 2, 2});
  EXPECT_THAT(map.blocks, ElementsAre(image::Point{1, 0}, image::Point{2, 0}, image::Point{1, 1},
                                      image::Point{2, 1}));
  EXPECT_THAT(map.around(3), ElementsAre(0, 1, -1, 2, 3, -1, -1, -1, -1));
}

}  // namespace
}  // namespace flowdlo::field
