#include "overlay.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include "overlay_style.hpp"
#include "tools/sample_estimate.hpp"

namespace flowdlo::tools {
namespace {

/// Gray, 640 x 480, with the sample's rope (fx such that it spans columns 80 to 544) masked.
struct Scene {
  std::vector<float> depth_m = std::vector<float>(640 * 480, 0.5F);
  std::vector<std::uint8_t> mask = std::vector<std::uint8_t>(640 * 480, 0);
  std::vector<std::uint8_t> color_bgr = std::vector<std::uint8_t>(640 * 480 * 3, 128);

  Scene() {
    for (int v = 235; v < 246; ++v) {
      for (int u = 80; u < 544; ++u) mask[static_cast<std::size_t>(v) * 640 + u] = 255;
    }
  }
  [[nodiscard]] Frame frame() const {
    return {640, 480, {800.0F, 800.0F, 320.0F, 240.0F}, depth_m, mask, color_bgr};
  }
};

int pixels_near(const support::Picture& picture, const Color& color, const image::Rect& window) {
  int count = 0;
  for (int v = window.y; v < window.y + window.height; ++v) {
    for (int u = window.x; u < window.x + window.width; ++u) {
      const Color& pixel = picture.at(v, u);
      count += std::equal(pixel.begin(), pixel.end(), color.begin(),
                          [](int a, int b) { return std::abs(a - b) <= 12; })
                   ? 1
                   : 0;
    }
  }
  return count;
}

constexpr image::Size kFrame{640, 480};

TEST(Overlay, HasTheSizeOfTheFrame) {
  const Scene scene;
  const auto picture = draw_overlay(scene.frame(), test::sample_estimate(), "cpu");
  EXPECT_EQ(picture.size(), kFrame);
}

TEST(Overlay, CurveIsColouredBySupport) {
  const Scene scene;
  const auto picture = draw_overlay(scene.frame(), test::sample_estimate(), "cpu");
  // Nodes 20 to 29 are bridged: columns 227 to 293; the others supported.
  const image::Rect bridged{235, 230, 50, 20};
  const image::Rect supported{320, 230, 150, 20};
  EXPECT_GT(pixels_near(picture, kBridgedColor, bridged), 50);
  EXPECT_EQ(pixels_near(picture, kSupportedColor, bridged), 0);
  EXPECT_GT(pixels_near(picture, kSupportedColor, supported), 150);
  EXPECT_EQ(pixels_near(picture, kBridgedColor, supported), 0);
}

TEST(Overlay, TheStrandFieldColoursTheImageWhereItSeesAnAxis) {
  const Scene scene;
  // A field of twice the frame's pixels around column 300 and row 340, an upright axis in its
  // middle, a tip at its top.
  SeenStrands strands{
      .width = 40, .height = 40, .first_u = 290, .first_v = 330, .scale_u = 2, .scale_v = 2};
  strands.channels.assign(10 * 40 * 40, 0);
  for (int v = 0; v < 40; ++v) {
    for (int u = 16; u < 24; ++u) {
      const auto pixel = static_cast<std::size_t>(v * 40 + u);
      strands.channels[pixel] = 1;                               // centre
      strands.channels[1600 + pixel] = -1;                       // twice a right angle
      strands.channels[3 * 1600 + pixel] = v < 8 ? 1.0F : 0.0F;  // tip
    }
  }
  const auto plain = draw_overlay(scene.frame(), Estimate{}, "cpu");
  const auto tinted = draw_overlay(scene.frame(), Estimate{}, "cpu", &strands);
  const auto at = [&](int u, int v) { return tinted.at(v, u); };
  EXPECT_EQ(at(300, 345), (Color{0, 128, 255}));
  EXPECT_EQ(at(300, 331), kWhite);
  for (const auto& [u, v] : {std::pair{292, 340}, {308, 340}, {300, 328}, {300, 352}}) {
    EXPECT_EQ(at(u, v), plain.at(v, u)) << u << ", " << v;
  }
  strands.first_u = 639;  // what reaches beyond the frame is left out
  EXPECT_EQ(draw_overlay(scene.frame(), Estimate{}, "cpu", &strands).size(), plain.size());
}

TEST(Overlay, EndsAreMarkedBeyondTheTips) {
  const Scene scene;
  const auto picture = draw_overlay(scene.frame(), test::sample_estimate(), "cpu");
  EXPECT_GT(pixels_near(picture, kWhite, {52, 225, 25, 30}), 60) << "A, white";
  EXPECT_GT(pixels_near(picture, kRimColor, {548, 225, 25, 30}), 60) << "B, dark";
}

TEST(Overlay, DoubtsAreALineOfTheLegend) {
  const Scene scene;
  Estimate estimate = test::sample_estimate();
  const auto height_px = [&] {
    const auto picture = draw_overlay(scene.frame(), estimate, "cpu");
    int dark = 0;
    for (int v = 0; v < 200; ++v) dark += picture.at(v, 12)[1] < 40 ? 1 : 0;
    return dark;
  };
  estimate.one_rope.doubts.clear();
  const int without = height_px();
  estimate.one_rope.doubts = {Doubt::kNoDepth, Doubt::kGoesOn};
  EXPECT_GT(without, 40);
  EXPECT_NEAR(height_px(), 1.25 * without, 0.1 * without) << "four lines were there";
}

TEST(Overlay, MaskIsOutlinedAlongItsBorderAndNowhereElse) {
  const Scene scene;
  const auto picture = draw_overlay(scene.frame(), Estimate{}, "cpu");
  const auto at = [&](int u, int v) { return picture.at(v, u)[0]; };
  const auto plain = at(300, 120);
  EXPECT_GT(at(300, 235), plain + 40) << "the topmost row of the mask";
  EXPECT_GT(at(300, 245), plain + 40) << "the lowest";
  EXPECT_GT(at(80, 240), plain + 40) << "the leftmost column";
  EXPECT_EQ(at(300, 240), plain) << "inside";
  EXPECT_EQ(at(300, 231), plain) << "well outside";
}

TEST(Overlay, NearerStrandIsDrawnOverTheOther) {
  Scene scene;
  auto estimate = test::sample_estimate();
  // First half along the row, far; second half across it, near and bridged.
  for (std::size_t j = 0; j < 64; ++j) {
    const auto along = static_cast<float>(j % 32) / 31.0F - 0.5F;
    estimate.nodes[j] =
        j < 32 ? Point3{0.2F * along, 0.0F, 0.5F} : Point3{0.0F, 0.2F * along, 0.4F};
    estimate.support[j] = j < 32 ? 1 : 0;
  }
  const image::Rect crossing{319, 239, 3, 3};
  const auto above = draw_overlay(scene.frame(), estimate, "cpu");
  EXPECT_EQ(pixels_near(above, kSupportedColor, crossing), 0);
  for (std::size_t j = 32; j < 64; ++j) estimate.nodes[j].z = 0.6F;
  const auto below = draw_overlay(scene.frame(), estimate, "cpu");
  EXPECT_EQ(pixels_near(below, kBridgedColor, crossing), 0);
}

TEST(Overlay, IsDrawnOnTheMaskWhereThereIsNoColour) {
  Scene scene;
  scene.color_bgr.clear();
  const auto picture = draw_overlay(scene.frame(), test::sample_estimate(), "cpu");
  EXPECT_EQ(picture.size(), kFrame);
  EXPECT_GT(pixels_near(picture, kSupportedColor, {320, 230, 150, 20}), 150);
}

TEST(Overlay, OfASmallFrameIsAWholeMultipleOfIt) {
  const std::vector<float> depth_m(80 * 60, 0.5F);
  const std::vector<std::uint8_t> mask(80 * 60, 0);
  const Frame frame{80, 60, {100.0F, 100.0F, 39.5F, 29.5F}, depth_m, mask, {}};
  EXPECT_EQ(draw_overlay(frame, test::sample_estimate(), "cpu").size(), (image::Size{480, 360}));
}

TEST(Overlay, OfOneColumnOfPixelsStaysSmall) {
  const std::vector<float> depth_m(4096, 0.5F);
  const std::vector<std::uint8_t> mask(4096, 255);
  const Frame frame{1, 4096, {100.0F, 100.0F, 0.0F, 0.0F}, depth_m, mask, {}};
  EXPECT_EQ(draw_overlay(frame, test::sample_estimate(), "cpu").size(), (image::Size{1, 4096}));
}

TEST(Overlay, CurvesThatCannotBeDrawnLeaveThePicture) {
  const Scene scene;
  auto estimate = test::sample_estimate();
  estimate.nodes[3].x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(draw_overlay(scene.frame(), estimate, "cpu").size(), kFrame);
  for (auto& node : estimate.nodes) node = {1.0e6F, -1.0e6F, 0.001F};
  EXPECT_EQ(draw_overlay(scene.frame(), estimate, "cpu").size(), kFrame);
}

TEST(RopesOverlay, EachRopeHasItsColourAndTheUpperOneIsWhole) {
  const Scene scene;
  const auto picture = draw_overlay(scene.frame(), {test::sample_ropes(), {}, {}}, "cpu");
  EXPECT_EQ(picture.size(), kFrame);
  EXPECT_GT(pixels_near(picture, rope_color(0), {330, 230, 150, 20}), 150);
  EXPECT_EQ(pixels_near(picture, rope_color(1), {330, 230, 150, 20}), 0);
  EXPECT_GT(pixels_near(picture, rope_color(1), {315, 300, 12, 80}), 100);
  const image::Rect crossing{317, 236, 7, 9};  // where both run
  EXPECT_GT(pixels_near(picture, rope_color(1), crossing), 10);
  EXPECT_EQ(pixels_near(picture, rope_color(0), crossing), 0);
}

TEST(RopesOverlay, ARopeKeepsItsColourThroughAStream) {
  const Scene scene;
  const auto alone = draw_overlay(scene.frame(), {test::sample_ropes(), {}, {}}, "cpu");
  const auto tracked = draw_overlay(scene.frame(), {test::sample_ropes(), {2, 4}, {}}, "cpu");
  const image::Rect of_first{330, 230, 150, 20};
  EXPECT_EQ(pixels_near(tracked, rope_color(1), of_first),
            pixels_near(alone, rope_color(0), of_first));
  EXPECT_EQ(pixels_near(tracked, rope_color(0), of_first), 0);
}

}  // namespace
}  // namespace flowdlo::tools
