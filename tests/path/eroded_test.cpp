// The eroded mask, drawn by hand with the fault that it does not mind.
#include "path/eroded.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "canvas.hpp"

namespace flowdlo::test {
namespace {

constexpr float kDepth_m = 0.6F;

Curve wave(double from, double to) {
  return curve_of([=](double t) {
    return std::pair{from + (to - from) * t, 230 + 110 * std::sin(2 * std::numbers::pi * t)};
  });
}

Canvas painted(const Curve& curve, int width_px, int columns = 640, int rows = 480) {
  Canvas canvas(columns, rows);
  canvas.stroke(curve, width_px).depth(curve, width_px + 4, kDepth_m);
  return canvas;
}

TEST(Eroded, RunsAlongACleanRopeInTheFramesPixels) {
  const Canvas canvas = painted(wave(60, 560), 12, 639, 479);
  const auto traced = path::trace_eroded(canvas.frame(), 12);
  ASSERT_TRUE(traced);
  EXPECT_LT(frechet(traced->ranked.front(), dense(wave(60, 560))), 10.0F);
  EXPECT_NEAR(traced->ranked.front().width_px, 12.0F, 2.5F);
  EXPECT_NEAR(traced->rope_width_px, 12.0F, 2.5F);
}

TEST(Eroded, OfAThickRopeMoreThanABrushReaches) {
  const Curve line{{200, 400}, {1000, 400}};
  const Canvas canvas = painted(line, 300, 1200, 800);
  const auto traced = path::trace_eroded(canvas.frame(), 300);
  ASSERT_TRUE(traced);
  EXPECT_NEAR(traced->rope_width_px, 300.0F, 10.0F);
}

TEST(Eroded, SamplesAreAboutAPixelApart) {
  const Canvas canvas = painted(wave(60, 560), 12);
  const auto traced = path::trace_eroded(canvas.frame(), 12);
  ASSERT_TRUE(traced);
  const auto& path = traced->ranked.front();
  ASSERT_EQ(path.points_px.size(), path.bridged.size());
  for (std::size_t i = 1; i < path.points_px.size(); ++i) {
    const float step = (path.points_px[i] - path.points_px[i - 1]).norm();
    EXPECT_GT(step, 0.1F);
    EXPECT_LT(step, 1.8F);
  }
}

TEST(Eroded, AThreadBetweenTwoEndsIsCut) {
  const Curve open = curve_of([](double t) {
    const double angle = (0.06 + 1.88 * t) * std::numbers::pi;
    return std::pair{320 + 130 * std::cos(angle), 240 + 130 * std::sin(angle)};
  });
  Canvas canvas = painted(open, 12);
  canvas.stroke({{450, 205}, {450, 275}}, 1);  // across the mouth
  const auto given = path::trace(canvas.frame());
  const auto eroded = path::trace_eroded(canvas.frame(), 12);
  ASSERT_TRUE(given);
  ASSERT_TRUE(eroded);
  EXPECT_TRUE(given->ranked.front().ring);
  EXPECT_FALSE(eroded->ranked.front().ring);
  EXPECT_LT(frechet(eroded->ranked.front(), dense(open)), 10.0F);
}

TEST(Eroded, ARopeAtTheImagesCornerStaysInTheImage) {
  const Canvas canvas = painted({{0, 3}, {636, 3}}, 7);
  const auto traced = path::trace_eroded(canvas.frame(), 7);
  ASSERT_TRUE(traced);
  for (const Vector2f& p : traced->ranked.front().points_px) {
    EXPECT_GE(p.minCoeff(), 0);
    EXPECT_LE(p.x(), 639);
    EXPECT_LE(p.y(), 479);
  }
}

TEST(Eroded, AnEmptyMaskHasNoPath) {
  const Canvas canvas;
  const auto traced = path::trace_eroded(canvas.frame(), 7);
  ASSERT_FALSE(traced);
  EXPECT_EQ(traced.error().code, ErrorCode::kNoPath);
}

TEST(Eroded, AThreadOfAPixelLeavesNothing) {
  const Canvas canvas = painted({{100, 100}, {400, 100}}, 1);
  const auto traced = path::trace_eroded(canvas.frame(), 1);
  ASSERT_FALSE(traced);
  EXPECT_EQ(traced.error().code, ErrorCode::kNoPath);
}

TEST(Eroded, OfAMaskTooLargeToBeTracedAsItIsHasItsWidthAndPlace) {
  Canvas large(4096, 4096);
  const Curve line{{40, 40}, {4000, 4000}};
  large.stroke(line, 60);
  const auto traced = path::trace_eroded(large.frame(), 60);
  ASSERT_TRUE(traced);
  EXPECT_NEAR(traced->rope_width_px, 60.0F, 6.0F);
  EXPECT_LT(frechet(traced->ranked.front(), dense(line)), 45.0F);
}

}  // namespace
}  // namespace flowdlo::test
