#include "geometry/mask_box.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

namespace flowdlo::geometry {
namespace {

TEST(MaskBox, HoldsEveryPixelAbove127AndNoRowOrColumnWithoutOne) {
  constexpr int kWidth = 67;
  constexpr int kHeight = 41;
  std::mt19937 random(5);
  for (int count = 0; count < 40; ++count) {
    std::vector<std::uint8_t> mask(kWidth * kHeight, 127);
    int left = kWidth;
    int right = -1;
    int top = kHeight;
    int bottom = -1;
    for (int i = 0; i < count / 4; ++i) {
      const auto at = static_cast<int>(random() % mask.size());
      mask[static_cast<std::size_t>(at)] = i % 2 == 0 ? 128 : 255;
      left = std::min(left, at % kWidth);
      right = std::max(right, at % kWidth);
      top = std::min(top, at / kWidth);
      bottom = std::max(bottom, at / kWidth);
    }
    const std::vector<float> depth_m(mask.size(), 1.0F);
    const image::Rect box = mask_box({kWidth, kHeight, {}, depth_m, mask, {}});
    if (right < 0) {
      EXPECT_EQ(box.width, 0);
      EXPECT_EQ(box.height, 0);
      continue;
    }
    EXPECT_EQ(box.x, left);
    EXPECT_EQ(box.y, top);
    EXPECT_EQ(box.width, right - left + 1);
    EXPECT_EQ(box.height, bottom - top + 1);
  }
}

TEST(FirstMasked, IsTheFirstPixelAbove127FromAnyPlaceOn) {
  std::vector<std::uint8_t> pixels(37, 127);
  for (const std::size_t set : {3U, 16U, 36U}) pixels[set] = 128;
  const int count = static_cast<int>(pixels.size());
  for (int from = 0; from <= count; ++from) {
    int expected = from;
    while (expected < count && pixels[static_cast<std::size_t>(expected)] <= 127) ++expected;
    EXPECT_EQ(first_masked(pixels.data(), from, count), expected) << from;
  }
}

}  // namespace
}  // namespace flowdlo::geometry
