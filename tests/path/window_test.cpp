#include "path/window.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "canvas.hpp"
#include "geometry/mask_box.hpp"
#include "path/region.hpp"

namespace flowdlo::test {
namespace {

path::Traversals one(std::vector<Vector2f> points, std::vector<std::uint8_t> bridged) {
  path::Traversals traversals;
  traversals.rope_width_px = 12;
  path::Path path;
  path.points_px = std::move(points);
  path.bridged = std::move(bridged);
  path.width_px = 10;
  path.score = -3;
  path.ring = true;
  path.hidden_ends = 0.5F;
  traversals.ranked.push_back(path);
  return traversals;
}

TEST(Window, PixelCentresStayWhereTheyAre) {  // Eq. (2.2)
  const path::Window window{{40, 30, 100, 80}, 2};
  const Intrinsics camera = window.camera({500, 510, 90, 60});
  EXPECT_FLOAT_EQ(camera.fx, 1000);
  EXPECT_FLOAT_EQ(camera.fy, 1020);
  auto traced = one({{camera.cx, camera.cy}, {camera.cx + 2, camera.cy}}, {0, 0});
  window.restore(traced, {640, 480});
  EXPECT_LT((traced.ranked[0].points_px[0] - Vector2f(90, 60)).norm(), 1e-4F);
  EXPECT_LT((traced.ranked[0].points_px[1] - Vector2f(91, 60)).norm(), 1e-4F);
}

TEST(Window, APlaceInItIsRestoredToWhereItWas) {
  const Vector2f p(61.5F, 47.25F);
  for (const float scale : {2.0F, 1.0F, 0.5F}) {
    const path::Window window{{40, 30, 100, 80}, scale};
    auto traced = one({window.place_of(p), window.place_of(p + Vector2f(8, 0))}, {0, 0});
    window.restore(traced, {640, 480});
    EXPECT_LT((traced.ranked[0].points_px.front() - p).norm(), 1e-4F) << scale;
  }
}

TEST(Window, EnlargedSamplesAreThinnedOutAndEndsKept) {
  auto traced = one({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}}, {0, 0, 1, 1, 0, 0});
  path::Window{{10, 20, 50, 50}, 2}.restore(traced, {640, 480});
  const auto& path = traced.ranked[0];
  ASSERT_EQ(path.points_px.size(), 4U);
  EXPECT_EQ(path.bridged, (std::vector<std::uint8_t>{0, 1, 0, 0}));
  EXPECT_LT((path.points_px.back() - Vector2f(12.25F, 19.75F)).norm(), 1e-5F);
}

TEST(Window, SamplesOfASmallerOneAreFilledUpAndLinksStayLinks) {
  auto traced = one({{0, 0}, {1, 0}, {2, 0}}, {0, 0, 1});
  path::Window{{0, 0, 64, 64}, 0.5F}.restore(traced, {64, 64});
  const auto& path = traced.ranked[0];
  ASSERT_EQ(path.points_px.size(), 5U);
  for (std::size_t i = 1; i < path.points_px.size(); ++i) {
    EXPECT_NEAR((path.points_px[i] - path.points_px[i - 1]).norm(), 1, 1e-5);
  }
  EXPECT_EQ(path.bridged, (std::vector<std::uint8_t>{0, 0, 0, 1, 1}));
}

TEST(Window, WidthsAreTheFramesAndTheRestStaysAsItWas) {
  auto traced = one({{0, 0}, {9, 0}}, {0, 0});
  path::Window{{0, 0, 64, 64}, 2}.restore(traced, {64, 64});
  EXPECT_FLOAT_EQ(traced.rope_width_px, 6);
  EXPECT_FLOAT_EQ(traced.ranked[0].width_px, 5);
  EXPECT_DOUBLE_EQ(traced.ranked[0].score, -3);
  EXPECT_TRUE(traced.ranked[0].ring);
  EXPECT_FLOAT_EQ(traced.ranked[0].hidden_ends, 0.5F);
}

TEST(Window, NothingLeavesTheFrame) {
  auto traced = one({{-3, -3}, {200, 200}}, {0, 0});
  path::Window{{0, 0, 64, 48}, 1}.restore(traced, {64, 48});
  EXPECT_EQ(traced.ranked[0].points_px.front(), Vector2f(0, 0));
  EXPECT_EQ(traced.ranked[0].points_px.back(), Vector2f(63, 47));
}

/// How a stroke so wide, or noise, from corner to corner of an image would be reduced.
int reduction_for(const cv::Size& size, int width_px, int noise_percent = 0) {
  Canvas canvas(size.width, size.height);
  canvas.stroke({{0, 0}, {size.width - 1, size.height - 1}}, width_px);
  cv::RNG random(3);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      if (random.uniform(0, 100) < noise_percent) canvas.mask.at<std::uint8_t>(v, u) = 255;
    }
  }
  const Frame frame = canvas.frame();
  return path::reduction_of(frame, geometry::mask_box(frame));
}

TEST(Reduction, AnImageOfFullHdIsReadAsItIs) {
  EXPECT_EQ(reduction_for({1920, 1080}, 5), 1);
  EXPECT_EQ(reduction_for({1920, 1080}, 90), 1);
  EXPECT_EQ(reduction_for({1920, 1080}, 5, 50), 1);
}

TEST(Reduction, OfALargerOneOnlyThinStrokesAreReadAsTheyAre) {
  EXPECT_EQ(reduction_for({3200, 2400}, 12), 1);
  EXPECT_EQ(reduction_for({3200, 2400}, 40), 2);
  EXPECT_EQ(reduction_for({3200, 2400}, 12, 30), 2) << "noise is no thin stroke";
  EXPECT_EQ(reduction_for({4096, 4096}, 12), 2) << "more than is ever read";
  EXPECT_EQ(reduction_for({4096, 4096}, 60), 3);
}

}  // namespace
}  // namespace flowdlo::test
