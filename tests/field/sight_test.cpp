#include "field/sight.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace flowdlo::field {
namespace {

/// A straight rope 8 px wide across a table that recedes, seen by a camera of 96 x 64 px.
struct Scene {
  static constexpr int kWidth = 96;
  static constexpr int kHeight = 64;
  std::vector<float> depth_m;
  std::vector<std::uint8_t> mask;
  std::vector<std::uint8_t> color;

  Scene() {
    for (int v = 0; v < kHeight; ++v) {
      for (int u = 0; u < kWidth; ++u) {
        const bool rope = v >= 28 && v < 36;
        const float table = 0.5F + 0.001F * static_cast<float>(u);
        depth_m.push_back(rope ? table - kHeight_m : table);
        mask.push_back(rope ? 255 : 0);
        for (const int level : {rope ? 200 : 90, rope ? 40 : 90, rope ? 30 : 90}) {
          color.push_back(static_cast<std::uint8_t>(level));
        }
      }
    }
  }
  [[nodiscard]] Frame frame() const {
    return {kWidth, kHeight, {500, 500, 48, 32}, depth_m, mask, color};
  }
  [[nodiscard]] Planes input(const Frame& frame) const {
    return input_of(look(frame, region_around({0, 28, kWidth, 8}, {kWidth, kHeight}, 8)));
  }
  /// Above the table; the rope is 8 mm wide at half a metre.
  static constexpr float kHeight_m = 0.008F;
};

float at(const Planes& input, int u, int v, Plane plane) { return input.at(v, u)[plane]; }

// The region begins at row 28 - 28, so that its rows are the frame's.
constexpr int kRopeRow = 32;
constexpr int kTableRow = 10;

TEST(Sight, ColorsAreThoseOfTheRopeLessTheRopes) {
  const Scene scene;
  const Planes input = scene.input(scene.frame());
  for (const Plane plane : {kBlue, kGreen, kRed}) {
    EXPECT_NEAR(at(input, 40, kRopeRow, plane), 0, 1e-5F);
  }
  EXPECT_LT(at(input, 40, kTableRow, kBlue), -1);
  EXPECT_GT(at(input, 40, kTableRow, kGreen), 1);
  EXPECT_EQ(at(input, 40, kTableRow, kHasColor), 1);
}

TEST(Sight, AGreyOrColorlessCameraLeavesTheColorsOut) {
  const Scene scene;
  Frame frame = scene.frame();
  frame.color_bgr = {};
  const Planes input = scene.input(frame);
  for (const Plane plane : {kBlue, kGreen, kRed, kHasColor}) {
    EXPECT_EQ(at(input, 40, kTableRow, plane), 0);
  }
  EXPECT_GT(at(input, 40, kTableRow, kDepth), 0);
}

TEST(Sight, APictureOfOneColorIsNone) {
  Scene scene;
  std::fill(scene.color.begin(), scene.color.end(), std::uint8_t{0});
  EXPECT_EQ(at(scene.input(scene.frame()), 40, kTableRow, kHasColor), 0);
  scene.color[0] = 1;  // one pixel's blue
  EXPECT_EQ(at(scene.input(scene.frame()), 40, kTableRow, kHasColor), 1);
}

TEST(Sight, BlocksOnTheirOwnAreThoseOfTheWhole) {
  const Scene scene;
  const Frame frame = scene.frame();
  for (const float rope_width_px : {3.0F, 5.0F, 8.0F, 11.0F}) {
    const Region region = region_around({0, 28, 30, 8}, {96, 64}, rope_width_px);
    const Sight sight = look(frame, region);
    const Planes whole = input_of(sight);
    threads::Pool pool(2);
    const auto blocks = std::make_shared<const BlockMap>(blocks_near(frame, region, &pool));
    ASSERT_EQ(blocks->blocks, blocks_near(sight.mask).blocks);
    const NearSight near = look(frame, region, blocks, &pool);
    const Input input(near);
    auto parts = BlockImage<PlanesOfPixel>::over(region.size, blocks);
    for (std::size_t i = 0; i < blocks->blocks.size(); ++i) input.planes_of(i, parts.block(i));
    parts.for_rows([&](int v, int u, const PlanesOfPixel* at, int count) {
      EXPECT_TRUE(std::equal(at, at + count, whole.row(v) + u)) << rope_width_px;
    });
  }
}

TEST(Sight, DepthIsThatOfTheRopeAroundInUnitsOfTwoWidths) {
  const Scene scene;
  const Planes input = scene.input(scene.frame());
  // Eight pixels at 0.54 m and 500 px are 8.6 mm; the table lies 8 mm behind the rope.
  EXPECT_NEAR(at(input, 48, kRopeRow, kDepth), 0, 0.05F);
  EXPECT_NEAR(at(input, 48, kTableRow, kDepth), 0.008F / (2 * 8 * 0.54F / 500), 0.03F);
  // Likewise at the image's border, where only one side tells the rope's depth.
  for (const int u : {1, 8, 94}) {
    EXPECT_NEAR(at(input, u, kRopeRow, kDepth), 0, 0.1F) << u;
    EXPECT_NEAR(at(input, u, kTableRow, kDepth), 0.46F, 0.1F) << u;
  }
}

TEST(Sight, NoDepthIsNoDepthWhateverStandsForIt) {
  Scene scene;
  const auto pixel = [](int u, int v) { return static_cast<std::size_t>(v * Scene::kWidth + u); };
  scene.depth_m[pixel(40, kTableRow)] = 0;
  scene.depth_m[pixel(50, kTableRow)] = std::numeric_limits<float>::quiet_NaN();
  scene.depth_m[pixel(60, kTableRow)] = std::numeric_limits<float>::infinity();
  scene.depth_m[pixel(70, kTableRow)] = -1;
  const Planes input = scene.input(scene.frame());
  for (const int u : {40, 50, 60, 70}) {
    EXPECT_EQ(at(input, u, kTableRow, kHasDepth), 0) << u;
    EXPECT_EQ(at(input, u, kTableRow, kDepth), 0) << u;
  }
  EXPECT_EQ(at(input, 41, kTableRow, kHasDepth), 1);
}

TEST(Sight, WithoutAnyDepthOnTheRopeThereIsNoneToCompareWith) {
  Scene scene;
  scene.depth_m.assign(scene.depth_m.size(), 0);
  const Planes input = scene.input(scene.frame());
  EXPECT_EQ(at(input, 40, kTableRow, kHasDepth), 0);
  EXPECT_EQ(at(input, 40, kRopeRow, kMask), 1);
}

TEST(Sight, NothingOfItIsLargeOrNoNumber) {
  Scene scene;
  for (std::size_t i = 0; i < scene.depth_m.size(); i += 7) scene.depth_m[i] = 1e30F;
  const Planes input = scene.input(scene.frame());
  for (std::size_t i = 0; i < input.total(); ++i) {
    for (const float value : input.data()[i]) ASSERT_LE(std::abs(value), 3);
  }
}

TEST(Sight, SmallerAndLargerRopesLookTheSame) {
  // The same rope seen by a camera of twice the resolution, resampled to the same region.
  const Scene scene;
  const Planes small = scene.input(scene.frame());
  std::vector<float> depth_m;
  std::vector<std::uint8_t> mask;
  std::vector<std::uint8_t> color;
  for (int v = 0; v < 2 * Scene::kHeight; ++v) {
    for (int u = 0; u < 2 * Scene::kWidth; ++u) {
      const auto pixel = static_cast<std::size_t>(v / 2 * Scene::kWidth + u / 2);
      depth_m.push_back(scene.depth_m[pixel]);
      mask.push_back(scene.mask[pixel]);
      for (std::size_t k = 0; k < 3; ++k) color.push_back(scene.color[3 * pixel + k]);
    }
  }
  const Frame frame{
      2 * Scene::kWidth, 2 * Scene::kHeight, {1000, 1000, 96.5F, 64.5F}, depth_m, mask, color};
  const Planes large =
      input_of(look(frame, region_around({0, 56, 2 * Scene::kWidth, 16},
                                         {2 * Scene::kWidth, 2 * Scene::kHeight}, 16)));
  ASSERT_EQ(large.width(), small.width());
  for (const int v : {20, 24, kRopeRow}) {
    for (int plane = 0; plane < kPlanes; ++plane) {
      const int lower = v + (large.height() - small.height()) / 2;
      EXPECT_NEAR(at(large, 48, lower, static_cast<Plane>(plane)),
                  at(small, 48, v, static_cast<Plane>(plane)), 0.05F)
          << "row " << v << " plane " << plane;
    }
  }
}

}  // namespace
}  // namespace flowdlo::field
