#include "field/block_image.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace flowdlo::field {
namespace {

constexpr image::Size kSize{75, 43};  // 3 x 2 blocks

/// Of the blocks of column 1 alone, each pixel its number in the image.
BlockImage<int> column() {
  const auto map = std::make_shared<const BlockMap>(cut(all_blocks(kSize), {1, 0, 1, 2}));
  BlockImage<int> image(kSize, map, -1);
  for (int v = 0; v < kSize.height; ++v) {
    for (int u = kBlock_px; u < 2 * kBlock_px; ++u) image.at(v, u) = v * kSize.width + u;
  }
  return image;
}

TEST(BlockImage, PixelsThatAreNotStoredAreNothing) {
  const auto image = column();
  EXPECT_EQ(image.find(5, 31), nullptr);
  EXPECT_EQ(image.find(5, 64), nullptr);
  EXPECT_EQ(image.find(-1, 40), nullptr);
  EXPECT_EQ(image.find(43, 40), nullptr);
  ASSERT_NE(image.find(42, 63), nullptr);
  EXPECT_EQ(*image.find(42, 63), 42 * kSize.width + 63);
  EXPECT_EQ(image.at(5, 31), 0);
}

TEST(BlockImage, RowsComeInOrderAndEndWithTheImage) {
  std::vector<int> seen;
  BlockImage<int> image(kSize, 0);
  for (int i = 0; i < kSize.area(); ++i) image.at(i / kSize.width, i % kSize.width) = i;
  image.for_rows([&](int v, int u, const int* from, int count) {
    EXPECT_EQ(*from, v * kSize.width + u);
    seen.insert(seen.end(), from, from + count);
  });
  ASSERT_EQ(seen.size(), static_cast<std::size_t>(kSize.area()));
  for (int i = 0; i < kSize.area(); ++i) EXPECT_EQ(seen[static_cast<std::size_t>(i)], i);
}

TEST(BlockImage, WholeHasEveryPixel) {
  const auto whole = column().whole();
  ASSERT_EQ(whole.size(), kSize);
  for (int v = 0; v < kSize.height; ++v) {
    for (int u = 0; u < kSize.width; ++u) {
      const bool stored = u >= kBlock_px && u < 2 * kBlock_px;
      ASSERT_EQ(whole.at(v, u), stored ? v * kSize.width + u : 0) << u << ", " << v;
    }
  }
  const BlockImage<int> back{image::Image<const int>(whole)};
  EXPECT_EQ(back.at(7, 40), 7 * kSize.width + 40);
}

}  // namespace
}  // namespace flowdlo::field
