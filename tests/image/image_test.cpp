// Images share their pixels with their copies and parts.
#include "image/image.hpp"

#include <gtest/gtest.h>

namespace flowdlo::image {
namespace {

TEST(Image, PartsAreTheSamePixelsAndClonesOthers) {
  Image<int> whole({6, 4}, 0);
  Image<int> part = whole.part({2, 1, 3, 2});
  Image<int> copy = part.clone();
  part.fill(7);
  copy.fill(9);
  EXPECT_EQ(whole.at(1, 2), 7);
  EXPECT_EQ(whole.at(2, 4), 7);
  EXPECT_EQ(whole.at(2, 5), 0);
  EXPECT_EQ(whole.at(0, 2), 0);
  EXPECT_EQ(copy.stride(), 3);
  EXPECT_EQ(part.stride(), 6);
}

TEST(Image, APartKeepsThePixelsOfAnImageThatIsGone) {
  Image<int> part;
  {
    const Image<int> whole({600, 400}, 5);
    part = whole.part({100, 100, 200, 200});
  }
  EXPECT_EQ(part.at({199, 199}), 5);
}

TEST(Image, WithoutAPixelIsEmpty) {
  EXPECT_TRUE(Image<float>().empty());
  EXPECT_TRUE(Image<float>({0, 3}).empty());
  EXPECT_EQ(Image<float>({3, 0}).total(), 0U);
  EXPECT_TRUE(Image<float>({3, 0}, 1.0F).clone().empty());
}

TEST(Rect, WhatBothHoldIsNothingWhereTheyAreApart) {
  const Rect rect{10, 20, 30, 40};
  EXPECT_EQ((rect & Rect{30, 0, 100, 30}), (Rect{30, 20, 10, 10}));
  EXPECT_EQ((rect & Rect{40, 20, 5, 5}), Rect{});
  EXPECT_EQ(grown(rect, 2), (Rect{8, 18, 34, 44}));
  EXPECT_TRUE(rect.contains({39, 59}));
  EXPECT_FALSE(rect.contains({40, 59}));
}

}  // namespace
}  // namespace flowdlo::image
