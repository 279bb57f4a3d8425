// A mask by colour: what light does not change, and what is left out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "flowdlo/frame_folder.hpp"
#include "flowdlo/mask.hpp"
#include "mask/perceptual.hpp"
#include "mask/table_scene.hpp"
#include "support/source_dir.hpp"

namespace flowdlo {
namespace {

using ::testing::HasSubstr;
using testing::overlap;
using testing::pixels_of;
using testing::TableScene;

constexpr ColorBand kRed{.red = 200, .green = 30, .blue = 40};

/// The code of a colour that is lit `light` times as brightly.
int lit(int code, double light) {
  const double value = code / 255.0;
  const double linear =
      light * (value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
  const double shown =
      linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  return static_cast<int>(std::lround(255 * std::min(shown, 1.0)));
}

TEST(Perceived, IsThatOfOklabForThePrimaries) {  // of the paper's own table of conversions
  const auto white = mask::perceived(255, 255, 255);
  EXPECT_NEAR(white.lightness, 1, 1e-4);
  EXPECT_NEAR(white.green_red, 0, 1e-4);
  EXPECT_NEAR(white.blue_yellow, 0, 1e-4);
  const auto red = mask::perceived(255, 0, 0);
  EXPECT_NEAR(red.lightness, 0.6280, 1e-3);
  EXPECT_NEAR(red.green_red * red.lightness, 0.2249, 1e-3);
  EXPECT_NEAR(red.blue_yellow * red.lightness, 0.1258, 1e-3);
  const auto black = mask::perceived(0, 0, 0);
  EXPECT_EQ(black.lightness, 0);
  EXPECT_EQ(black.green_red, 0);
}

TEST(MaskFromColor, IsTheRopeWhereOneEndLiesInTheShade) {
  TableScene scene;
  for (int v = 0; v < TableScene::kHeight; ++v) {
    for (int u = 0; u < TableScene::kWidth; ++u) {
      const auto pixel = TableScene::at(u, v);
      const double light = 0.08 + 1.3 * u / TableScene::kWidth;
      const bool rope = scene.rope[pixel] != 0;
      scene.paint(pixel, lit(rope ? 200 : 120, light), lit(rope ? 30 : 120, light),
                  lit(rope ? 40 : 125, light));
    }
  }
  const auto mask = mask_from_color(scene.frame(), kRed);
  ASSERT_TRUE(mask) << mask.error().message;
  EXPECT_GT(overlap(*mask, scene.rope), 0.99);
}

TEST(MaskFromColor, LeavesThingsOfOtherHuesOut) {
  TableScene scene;
  const std::array<std::array<int, 3>, 4> others{
      {{{210, 130, 30}}, {{40, 160, 50}}, {{30, 60, 200}}, {{200, 190, 195}}}};
  for (std::size_t i = 0; i < others.size(); ++i) {
    for (int v = 5; v < 35; ++v) {
      for (int u = 40; u < 70; ++u) {
        scene.paint(TableScene::at(u + 60 * static_cast<int>(i), v), others[i][0], others[i][1],
                    others[i][2]);
      }
    }
  }
  const auto mask = mask_from_color(scene.frame(), kRed);
  ASSERT_TRUE(mask);
  EXPECT_GT(overlap(*mask, scene.rope), 0.99);
}

TEST(MaskFromColor, TellsAGreyRopeByItsLightness) {
  TableScene scene;
  for (std::size_t pixel = 0; pixel < scene.rope.size(); ++pixel) {
    const int grey = scene.rope[pixel] != 0 ? 235 : 120;
    scene.paint(pixel, grey, grey, grey);
  }
  const auto mask = mask_from_color(
      scene.frame(), {.red = 235, .green = 235, .blue = 235, .least_lightness = 0.8F});
  ASSERT_TRUE(mask);
  EXPECT_GT(overlap(*mask, scene.rope), 0.99);
}

TEST(MaskFromColor, FillsAHighlight) {
  TableScene scene;
  for (int u = 100; u < 106; ++u) {
    scene.paint(TableScene::at(u, static_cast<int>(TableScene::axis_v(u))), 255, 250, 250);
  }
  const auto mask = mask_from_color(scene.frame(), kRed);
  ASSERT_TRUE(mask);
  EXPECT_GT(overlap(*mask, scene.rope), 0.99);
}

TEST(MaskFromColor, IsEmptyWhereNothingHasTheColour) {
  const TableScene scene;
  const auto mask = mask_from_color(scene.frame(), {.red = 10, .green = 200, .blue = 20});
  ASSERT_TRUE(mask);
  EXPECT_EQ(pixels_of(*mask), 0U);
}

TEST(MaskFromColor, NeedsNeitherDepthNorMaskNorCamera) {
  const TableScene scene;
  Frame frame = scene.frame();
  const auto whole = mask_from_color(frame, kRed);
  frame.depth_m = {};
  frame.intrinsics = {};
  const auto alone = mask_from_color(frame, kRed);
  ASSERT_TRUE(alone) << alone.error().message;
  EXPECT_EQ(*alone, *whole);
}

TEST(MaskFromColor, OfTheExampleIsTheMaskThatShips) {
  const auto folder = load_frame_folder(test::source_dir() / "examples/frames/overhand_loop");
  ASSERT_TRUE(folder);
  const auto mask = mask_from_color(folder->frame(), {.red = 209, .green = 36, .blue = 36});
  ASSERT_TRUE(mask);
  EXPECT_GT(overlap(*mask, folder->mask), 0.9);
}

TEST(MaskFromColor, NamesEveryFault) {
  const TableScene scene;
  Frame frame = scene.frame();
  frame.color_bgr = frame.color_bgr.first(30);
  const auto mask =
      mask_from_color(frame, {.tolerance = 0, .least_lightness = -1, .most_lightness = 2});
  ASSERT_FALSE(mask);
  EXPECT_EQ(mask.error().code, ErrorCode::kBadInput);
  for (const char* what :
       {"color_bgr: expected 230400 values", "tolerance", "least_lightness", "most_lightness"}) {
    EXPECT_THAT(mask.error().message, HasSubstr(what));
  }
}

}  // namespace
}  // namespace flowdlo
