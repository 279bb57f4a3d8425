// What is rendered for who learns from a part of a frame: colours in windows, dense truth.
#include <gtest/gtest.h>

#include <cmath>

#include "synth/synthetic_frame.hpp"

namespace flowdlo::synth {
namespace {

constexpr std::uint64_t kSeed = 4;
constexpr Window kWindow{100, 60, 180, 130};

SyntheticFrame rendered(const Render& render) {
  auto frame = make_frame(Split::kWide, Part::kTraining, kSeed, 2, render);
  if (!frame) throw std::runtime_error(frame.error().message);
  return *std::move(frame);
}

std::size_t pixel(const SyntheticFrame& frame, int u, int v) {
  return static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.folder.width) +
         static_cast<std::size_t>(u);
}

TEST(Windows, HaveTheColorsOfTheWholeFrameAndTheRestIsBlack) {
  const SyntheticFrame whole = rendered({});
  Render render;
  render.windows = [](const SyntheticFrame&) { return std::vector<Window>{kWindow}; };
  const SyntheticFrame part = rendered(render);
  ASSERT_EQ(part.folder.color_bgr.size(), whole.folder.color_bgr.size());
  EXPECT_EQ(part.folder.depth_m, whole.folder.depth_m);
  EXPECT_EQ(part.folder.mask, whole.folder.mask);
  for (int v = 0; v < part.folder.height; ++v) {
    for (int u = 0; u < part.folder.width; ++u) {
      const bool inside =
          u >= kWindow.left && u < kWindow.right && v >= kWindow.top && v < kWindow.bottom;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t at = 3 * pixel(part, u, v) + k;
        ASSERT_EQ(part.folder.color_bgr[at], inside ? whole.folder.color_bgr[at] : 0)
            << u << ", " << v;
      }
    }
  }
}

TEST(Windows, AreChosenByWhatTheFrameShows) {
  Render render;
  render.dense = true;
  bool asked = false;
  render.windows = [&](const SyntheticFrame& frame) {
    asked = true;
    EXPECT_FALSE(frame.folder.depth_m.empty());
    EXPECT_TRUE(frame.dense);
    return std::vector<Window>{{-50, -50, 5000, 10}};  // beyond the image on three sides
  };
  const SyntheticFrame frame = rendered(render);
  EXPECT_TRUE(asked);
  EXPECT_NE(frame.folder.color_bgr[3 * pixel(frame, 5, 5)], 0);
  EXPECT_EQ(frame.folder.color_bgr[3 * pixel(frame, 5, 15)], 0);
}

TEST(DenseTruth, IsThereWhenItIsAskedFor) { EXPECT_FALSE(rendered({.color = false}).dense); }

TEST(DenseTruth, ItsCurveRunsThroughTheIdealMask) {
  const SyntheticFrame frame = rendered({.color = false, .dense = true});
  ASSERT_EQ(frame.dense->curves.size(), 1U);
  const Intrinsics& camera = frame.folder.intrinsics;
  int inside = 0;
  int on_rope = 0;
  for (const Vector3d& p : frame.dense->curves.front().points) {
    const auto u = static_cast<int>(std::lround(camera.fx * p.x() / p.z() + camera.cx));
    const auto v = static_cast<int>(std::lround(camera.fy * p.y() / p.z() + camera.cy));
    if (u < 0 || v < 0 || u >= frame.folder.width || v >= frame.folder.height) continue;
    ++inside;
    on_rope += frame.dense->mask[pixel(frame, u, v)] != 0;
  }
  EXPECT_GT(inside, 100);
  EXPECT_GT(on_rope, 0.5 * inside) << "the rest is hidden";
}

}  // namespace
}  // namespace flowdlo::synth
