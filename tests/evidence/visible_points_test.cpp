#include "evidence/visible_points.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace flowdlo::evidence {
namespace {

/// A frame that owns its pixels: nothing masked, every depth 1 m.
struct Picture {
  int width;
  int height;
  std::vector<float> depth_m = std::vector<float>(pixels(), 1.0F);
  std::vector<std::uint8_t> mask = std::vector<std::uint8_t>(pixels(), 0);
  Intrinsics intrinsics{500, 400, 2, 1};

  [[nodiscard]] std::size_t pixels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  [[nodiscard]] Frame frame() const { return {width, height, intrinsics, depth_m, mask, {}}; }
};

// Pixel (4, 3) at 2 m: x = (4 - 2) * 2 / 500, y = (3 - 1) * 2 / 400.
TEST(Unproject, FollowsEquation2_2WorkedByHand) {
  Picture picture{6, 5};
  picture.mask[3 * 6 + 4] = 255;
  picture.depth_m[3 * 6 + 4] = 2;
  const Cloud cloud = unproject(picture.frame());
  ASSERT_EQ(cloud.points_cam.size(), 1U);
  EXPECT_EQ(cloud.points_cam[0], (Point3{0.008F, 0.01F, 2}));
  EXPECT_EQ(cloud.pixels[0], 22);
}

TEST(Unproject, TakesMaskValuesAboveOneHalfOnly) {  // Sec. 3.2
  Picture picture{4, 1};
  picture.mask = {127, 128, 1, 255};
  EXPECT_EQ(unproject(picture.frame()).pixels, (std::vector<int>{1, 3}));
}

TEST(Unproject, TakesFiniteDepthsAboveOneMicrometreOnly) {  // Sec. 3.2
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Picture picture{9, 1};
  picture.mask.assign(9, 255);
  picture.depth_m = {0,         -1,         1e-6F, 1.1e-6F, std::numeric_limits<float>::quiet_NaN(),
                     kInfinity, -kInfinity, 0.5F,  3e37F};
  EXPECT_EQ(unproject(picture.frame()).pixels, (std::vector<int>{3, 7, 8}));
}

TEST(Unproject, OfMoreThanTwoMillionPixelsTakesEverySecondOrThird) {
  constexpr std::size_t kMost = std::size_t{1} << 21;
  Picture largest{1920, 1080};
  largest.mask.assign(largest.pixels(), 255);
  EXPECT_EQ(unproject(largest.frame()).pixels.size(), largest.pixels()) << "fits: all of them";
  Picture large{2048, 2049};
  large.mask.assign(large.pixels(), 255);
  const auto pixels = unproject(large.frame()).pixels;
  EXPECT_LE(pixels.size(), kMost);
  EXPECT_EQ(pixels.size(), (large.pixels() + 2) / 3);
  EXPECT_EQ(pixels[1], 3);
}

TEST(Unproject, LeavesOutADepthWhosePointOverflows) {
  Picture picture{100, 1};
  picture.intrinsics = {10, 10, 0, 0};
  picture.mask.assign(100, 255);
  picture.depth_m.assign(100, 3e38F);  // x = u * 3e38 / 10: overflows from u = 2 on
  for (const Point3& point : unproject(picture.frame()).points_cam) {
    EXPECT_LT(point.x, std::numeric_limits<float>::infinity());
  }
}

TEST(Unproject, KeepsRowMajorOrderForWidthsThatAreNoMultipleOfEight) {  // spec section 4
  for (const int width : {1, 7, 8, 9, 21}) {
    Picture picture{width, 3};
    std::vector<int> expected;
    for (int i = 0; i < width * 3; i += 5) {
      picture.mask[static_cast<std::size_t>(i)] = 200;
      expected.push_back(i);
    }
    EXPECT_EQ(unproject(picture.frame()).pixels, expected) << "width " << width;
  }
}

TEST(Unproject, FindsEachPixelOfTheBorder) {
  Picture picture{33, 17};
  for (const std::size_t pixel : {0, 32, 33 * 16, 33 * 17 - 1}) picture.mask[pixel] = 255;
  EXPECT_EQ(unproject(picture.frame()).pixels, (std::vector<int>{0, 32, 528, 560}));
}

TEST(Unproject, WorksOnAnImageOfOnePixel) {
  Picture picture{1, 1};
  EXPECT_TRUE(unproject(picture.frame()).points_cam.empty());
  picture.mask[0] = 255;
  EXPECT_EQ(unproject(picture.frame()).points_cam.size(), 1U);
}

TEST(Centroid, IsTheMeanOfAllPoints) {
  EXPECT_EQ(centroid({{{1, 2, 3}, {3, 6, 9}}, {0, 1}}), (Point3{2, 4, 6}));
}

TEST(Centroid, OfNothingIsZero) { EXPECT_EQ(centroid({}), (Point3{})); }

TEST(VisiblePoints, KeepAllOfAFewAndMarkRepetitionsInvalid) {  // Sec. 3.2
  const VisiblePoints visible = visible_points({{{1, 0, 1}, {2, 0, 1}}, {0, 1}});
  EXPECT_EQ(visible.count, 2);
  for (std::size_t i = 0; i < kVisiblePoints; ++i) {
    EXPECT_EQ(visible.points_cam[i].x, i % 2 == 0 ? 1.0F : 2.0F);
    EXPECT_EQ(visible.valid[i], i < 2 ? 1 : 0);
  }
}

TEST(VisiblePoints, AreZeroAndInvalidWithoutEvidence) {  // Sec. 3.2
  const VisiblePoints visible = visible_points({});
  EXPECT_EQ(visible.count, 0);
  EXPECT_EQ(visible.points_cam[0], (Point3{}));
  EXPECT_EQ(visible.points_cam[255], (Point3{}));
  EXPECT_EQ(visible.valid, decltype(visible.valid){});
}

TEST(VisiblePoints, SpreadOverALargeCloudFromTheFarthestOn) {  // Sec. 3.2
  Picture picture{640, 480};
  picture.intrinsics = {500, 500, 320, 240};
  picture.mask.assign(picture.pixels(), 255);
  const Cloud cloud = unproject(picture.frame());
  const VisiblePoints visible = visible_points(cloud);
  EXPECT_EQ(visible.count, kVisiblePoints);
  EXPECT_EQ(visible.valid[255], 1);
  // the corners are equally far from the centre but for rounding; all four are among the first
  float low = 0;
  float high = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    low = std::min(low, visible.points_cam[i].x);
    high = std::max(high, visible.points_cam[i].x);
  }
  EXPECT_EQ(low, cloud.points_cam.front().x);
  EXPECT_EQ(high, cloud.points_cam.back().x);
}

TEST(VisiblePoints, AreTheSameEveryTime) {
  Picture picture{64, 48};
  picture.mask.assign(picture.pixels(), 255);
  const Cloud cloud = unproject(picture.frame());
  EXPECT_EQ(visible_points(cloud).points_cam, visible_points(cloud).points_cam);
}

}  // namespace
}  // namespace flowdlo::evidence
