// Spec section 6: the field behind the local features.
#include "evidence/mask_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "random/philox.hpp"

namespace flowdlo::evidence {
namespace {

struct Picture {
  int width;
  int height;
  std::vector<float> depth_m = std::vector<float>(pixels(), 1.0F);
  std::vector<std::uint8_t> mask = std::vector<std::uint8_t>(pixels(), 0);

  [[nodiscard]] std::size_t pixels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  void set(int u, int v, std::uint8_t value = 255) {
    mask[static_cast<std::size_t>(v * width + u)] = value;
  }
  [[nodiscard]] Frame frame() const { return {width, height, {500, 500, 0, 0}, depth_m, mask, {}}; }
};

std::array<float, 4> texel(const MaskField& field, int u, int v) {
  const auto at = 4 * static_cast<std::size_t>(v * field.width + u);
  return {field.texels[at], field.texels[at + 1], field.texels[at + 2], field.texels[at + 3]};
}

TEST(MaskField, HalvesTheImageAndKeepsAtLeastOnePixel) {
  EXPECT_EQ(mask_field(Picture{640, 480}.frame()).width, 320);
  EXPECT_EQ(mask_field(Picture{640, 480}.frame()).height, 240);
  EXPECT_EQ(mask_field(Picture{1, 1}.frame()).width, 1);
  EXPECT_EQ(mask_field(Picture{1, 1}.frame()).height, 1);
  EXPECT_EQ(mask_field(Picture{7, 5}.frame()).width, 3);
  EXPECT_EQ(mask_field(Picture{7, 5}.frame()).texels.size(), 4U * 3 * 2);
}

TEST(MaskField, AveragesTwoByTwoPixels) {  // channel 0
  Picture picture{8, 6};
  picture.set(2, 2);
  picture.set(4, 2);
  picture.set(5, 3);
  picture.set(6, 5, 127);  // not mask
  const MaskField field = mask_field(picture.frame());
  EXPECT_EQ(texel(field, 1, 1)[0], 0.25F);
  EXPECT_EQ(texel(field, 2, 1)[0], 0.5F);
  EXPECT_EQ(texel(field, 3, 2)[0], 0);
}

// 5 px to 2: each field pixel covers 2.5; the middle column is shared half and half.
TEST(MaskField, SharesAPixelThatTwoFieldPixelsCover) {  // channel 0, odd sizes
  Picture picture{5, 2};
  picture.set(2, 0);
  picture.set(2, 1);
  const MaskField field = mask_field(picture.frame());
  EXPECT_NEAR(texel(field, 0, 0)[0], 0.2, 1e-6);
  EXPECT_NEAR(texel(field, 1, 0)[0], 0.2, 1e-6);
}

TEST(MaskField, SmoothsWithAGaussianOfTwoAndAHalfPixels) {  // channel 1
  Picture picture{160, 160};
  for (const int u : {80, 81}) {
    for (const int v : {80, 81}) picture.set(u, v);  // one full field pixel at (40, 40)
  }
  const MaskField field = mask_field(picture.frame());
  double sum = 0;
  for (int i = -10; i <= 10; ++i) sum += std::exp(-0.5 * i * i / 6.25);
  const double peak = 1 / (sum * sum);
  EXPECT_NEAR(texel(field, 40, 40)[1], peak, 1e-6);
  EXPECT_NEAR(texel(field, 43, 40)[1], peak * std::exp(-0.5 * 9 / 6.25), 1e-6);
  EXPECT_NEAR(texel(field, 40, 45)[1], peak * std::exp(-0.5 * 25 / 6.25), 1e-6);
}

// Far from corners, a full mask loses at the border row what the kernel holds outside: with
// g the sum of its 21 taps, (g + 1) / (2 g).
TEST(MaskField, SmoothsAsIfNothingLayOutsideTheImage) {  // channel 1
  Picture picture{160, 160};
  std::fill(picture.mask.begin(), picture.mask.end(), std::uint8_t{255});
  const MaskField field = mask_field(picture.frame());
  double sum = 0;
  for (int i = -10; i <= 10; ++i) sum += std::exp(-0.5 * i * i / 6.25);
  EXPECT_NEAR(texel(field, 40, 40)[1], 1, 1e-5);
  EXPECT_NEAR(texel(field, 40, 0)[1], (sum + 1) / (2 * sum), 1e-5);
}

// Only rows near the mask are smoothed, and even sides are averaged by counting.
TEST(MaskField, HasTheBitsOfFiltersOverTheWholeImage) {  // channels 0 and 1
  for (const int top : {0, 3, 60, 150}) {
    Picture picture{210, 160};
    for (int i = 0; i < 10 * 210; ++i) {
      if (random::philox(5, static_cast<std::uint64_t>(i))[0] % 3 == 0) {
        picture.set(i % 210, top + i / 210);
      }
    }
    const MaskField field = mask_field(picture.frame());

    cv::Mat1f mask;
    cv::Mat1b(160, 210, picture.mask.data()).convertTo(mask, CV_32F);
    cv::min(mask, 1.0, mask);
    cv::Mat1f average;
    cv::resize(mask, average, {105, 80}, 0, 0, cv::INTER_AREA);
    cv::Mat1f smooth;
    cv::GaussianBlur(average, smooth, {}, 2.5, 2.5, cv::BORDER_CONSTANT);
    for (int v = 0; v < field.height; ++v) {
      for (int u = 0; u < field.width; ++u) {
        ASSERT_EQ(texel(field, u, v)[0], average(v, u)) << top << ": " << u << ", " << v;
        ASSERT_EQ(texel(field, u, v)[1], smooth(v, u)) << top << ": " << u << ", " << v;
      }
    }
  }
}

TEST(MaskField, PointsFromEachPixelToTheNearestMaskPixel) {  // channels 2 and 3
  Picture picture{40, 40};
  picture.set(20, 10);  // field pixel (10, 5)
  const MaskField field = mask_field(picture.frame());
  EXPECT_EQ(texel(field, 10, 5)[2], 0);
  EXPECT_EQ(texel(field, 10, 5)[3], 0);
  EXPECT_EQ(texel(field, 3, 9)[2], 7);
  EXPECT_EQ(texel(field, 3, 9)[3], -4);
  EXPECT_EQ(texel(field, 19, 0)[2], -9);
  EXPECT_EQ(texel(field, 19, 0)[3], 5);
}

TEST(MaskField, IsFarFromEverythingWithoutAMask) {
  const Picture picture{640, 480};
  const MaskField field = mask_field(picture.frame());
  const auto [mask, smooth, du, dv] = texel(field, 160, 120);
  EXPECT_EQ(mask, 0);
  EXPECT_EQ(smooth, 0);
  // the local features clamp at 300 px of a 640-px-wide image, spec section 6
  EXPECT_GT(du * 640 / 320, 300);
  EXPECT_GT(dv * 640 / 320, 300);
}

TEST(MaskField, WorksOnAnImageOfOnePixel) {
  Picture picture{1, 1};
  picture.set(0, 0);
  const auto values = texel(mask_field(picture.frame()), 0, 0);
  EXPECT_EQ(values[0], 1);
  EXPECT_GT(values[1], 0);
  EXPECT_EQ(values[2], 0);
  EXPECT_EQ(values[3], 0);
}

TEST(MaskField, TakesMasksAtTheBorder) {
  Picture picture{64, 48};
  picture.set(63, 47);
  picture.set(0, 0);
  const MaskField field = mask_field(picture.frame());
  EXPECT_EQ(texel(field, 31, 23)[0], 0.25F);
  EXPECT_EQ(texel(field, 1, 0)[2], -1);
  EXPECT_EQ(texel(field, 30, 23)[2], 1);
}

TEST(MaskField, StaysBetweenZeroAndOneForAnySize) {
  for (const auto& [width, height] : {std::array{1, 9}, std::array{9, 1}, std::array{33, 47}}) {
    Picture picture{width, height};
    std::fill(picture.mask.begin(), picture.mask.end(), std::uint8_t{255});
    const MaskField field = mask_field(picture.frame());
    for (std::size_t i = 0; i < field.texels.size(); i += 4) {
      EXPECT_NEAR(field.texels[i], 1, 1e-5);
      EXPECT_LE(field.texels[i], 1);
      EXPECT_LE(field.texels[i + 1], 1 + 1e-5F);
    }
  }
}

TEST(MaskField, IsTheSameEveryTime) {
  Picture picture{65, 31};
  for (int i = 3; i < 28; ++i) picture.set(2 * i, i);
  EXPECT_EQ(mask_field(picture.frame()).texels, mask_field(picture.frame()).texels);
}

}  // namespace
}  // namespace flowdlo::evidence
