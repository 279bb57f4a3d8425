// Readings, on masks drawn by hand with the one fault that each of them does not mind.
#include "path/readings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "canvas.hpp"

namespace flowdlo::test {
namespace {

using path::Reading;

constexpr Reading kAll[] = {Reading::kAsGiven, Reading::kHalved,  Reading::kDoubled,
                            Reading::kEroded,  Reading::kDilated, Reading::kMeasured};
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

bool any_bridged(const path::Path& path) {
  return std::any_of(path.bridged.begin(), path.bridged.end(),
                     [](std::uint8_t value) { return value != 0; });
}

TEST(Readings, AllRunAlongACleanRopeInTheFramesPixels) {
  for (const int columns : {640, 639}) {  // odd sides do not halve
    const Canvas canvas = painted(wave(60, 560), 12, columns, 479);
    for (const Reading reading : kAll) {
      const auto traced = path::trace_as(reading, canvas.frame(), 12);
      ASSERT_TRUE(traced) << static_cast<int>(reading);
      EXPECT_LT(frechet(traced->ranked.front(), dense(wave(60, 560))), 10.0F)
          << static_cast<int>(reading);
      EXPECT_NEAR(traced->ranked.front().width_px, 12.0F, 2.5F) << static_cast<int>(reading);
      EXPECT_NEAR(traced->rope_width_px, 12.0F, 2.5F) << static_cast<int>(reading);
    }
  }
}

TEST(Readings, SamplesAreAboutAPixelApart) {
  const Canvas canvas = painted(wave(60, 560), 12);
  for (const Reading reading : kAll) {
    const auto traced = path::trace_as(reading, canvas.frame(), 12);
    ASSERT_TRUE(traced);
    const auto& path = traced->ranked.front();
    ASSERT_EQ(path.points_px.size(), path.bridged.size());
    for (std::size_t i = 1; i < path.points_px.size(); ++i) {
      const float step = (path.points_px[i] - path.points_px[i - 1]).norm();
      EXPECT_GT(step, 0.1F) << static_cast<int>(reading);
      EXPECT_LT(step, 1.8F) << static_cast<int>(reading);
    }
  }
}

TEST(Readings, AsGivenIsTheTrace) {
  const Canvas canvas = painted(wave(60, 560), 9);
  const auto read = path::trace_as(Reading::kAsGiven, canvas.frame(), 9);
  const auto traced = path::trace(canvas.frame());
  ASSERT_TRUE(read);
  ASSERT_TRUE(traced);
  EXPECT_EQ(read->ranked.front().points_px, traced->ranked.front().points_px);
}

TEST(Readings, ACutOfAPixelIsNoneOnceHalvedOrDilated) {
  Canvas canvas = painted(wave(60, 560), 12);
  canvas.erase({340, 0, 1, 480});
  const auto given = path::trace_as(Reading::kAsGiven, canvas.frame(), 12);
  ASSERT_TRUE(given);
  EXPECT_TRUE(any_bridged(given->ranked.front()));
  for (const Reading reading : {Reading::kHalved, Reading::kDilated}) {
    const auto traced = path::trace_as(reading, canvas.frame(), 12);
    ASSERT_TRUE(traced);
    EXPECT_FALSE(any_bridged(traced->ranked.front())) << static_cast<int>(reading);
    EXPECT_LT(frechet(traced->ranked.front(), dense(wave(60, 560))), 10.0F);
  }
}

TEST(Readings, AThreadBetweenTwoEndsIsCutOnceEroded) {
  const Curve open = curve_of([](double t) {
    const double angle = (0.06 + 1.88 * t) * std::numbers::pi;
    return std::pair{320 + 130 * std::cos(angle), 240 + 130 * std::sin(angle)};
  });
  Canvas canvas = painted(open, 12);
  canvas.stroke({{450, 205}, {450, 275}}, 1);  // across the mouth
  const auto given = path::trace_as(Reading::kAsGiven, canvas.frame(), 12);
  const auto eroded = path::trace_as(Reading::kEroded, canvas.frame(), 12);
  ASSERT_TRUE(given);
  ASSERT_TRUE(eroded);
  EXPECT_FALSE(eroded->ranked.front().ring);
  EXPECT_LT(frechet(eroded->ranked.front(), dense(open)), 10.0F);
}

TEST(Readings, WhatHasNoDepthIsNoneOnceMeasured) {
  const Curve line{{80, 240}, {560, 240}};
  Canvas canvas = painted(line, 10);
  canvas.stroke({{320, 247}, {320, 400}}, 10);  // bleeds, and nothing is measured there
  const auto given = path::trace_as(Reading::kAsGiven, canvas.frame(), 10);
  const auto measured = path::trace_as(Reading::kMeasured, canvas.frame(), 10);
  ASSERT_TRUE(given);
  ASSERT_TRUE(measured);
  const auto lowest = [](const path::Traversals& traced) {
    float v = 0;
    for (const Vector2f& p : traced.ranked.front().points_px) v = std::max(v, p.y());
    return v;
  };
  EXPECT_LT(lowest(*measured), 255.0F);
  EXPECT_LT(frechet(measured->ranked.front(), dense(line)), 10.0F);
}

TEST(Readings, ARopeAtTheImagesCornerStaysInTheImage) {
  const Curve line{{0, 3}, {636, 3}};
  const Canvas canvas = painted(line, 7);
  for (const Reading reading : kAll) {
    const auto traced = path::trace_as(reading, canvas.frame(), 7);
    ASSERT_TRUE(traced) << static_cast<int>(reading);
    for (const Vector2f& p : traced->ranked.front().points_px) {
      EXPECT_GE(p.minCoeff(), 0);
      EXPECT_LE(p.x(), 639);
      EXPECT_LE(p.y(), 479);
    }
  }
}

TEST(Readings, AnEmptyMaskHasNoPathHoweverItIsRead) {
  const Canvas canvas;
  for (const Reading reading : kAll) {
    const auto traced = path::trace_as(reading, canvas.frame(), 7);
    ASSERT_FALSE(traced);
    EXPECT_EQ(traced.error().code, ErrorCode::kNoPath);
  }
}

TEST(Readings, AThreadThatErosionLeavesNothingOfHasNoPathThen) {
  const Canvas canvas = painted({{100, 100}, {400, 100}}, 1);
  EXPECT_FALSE(path::trace_as(Reading::kEroded, canvas.frame(), 1));
}

bool listed(const std::vector<Reading>& readings, Reading reading) {
  return std::find(readings.begin(), readings.end(), reading) != readings.end();
}

TEST(FurtherReadings, OnlyThinRopesAreDoubled) {
  const Canvas canvas = painted(wave(60, 560), 12);
  EXPECT_TRUE(listed(path::further_readings(canvas.frame(), 5), Reading::kDoubled));
  EXPECT_FALSE(listed(path::further_readings(canvas.frame(), 20), Reading::kDoubled));
}

TEST(FurtherReadings, WhatIsMeasuredMattersOnlyWhereSomethingIsNot) {
  const Canvas whole = painted(wave(60, 560), 12);
  EXPECT_FALSE(listed(path::further_readings(whole.frame(), 12), Reading::kMeasured));
  Canvas holed = whole;
  cv::Mat(480, 640, CV_32F, holed.depth_m.data())(cv::Rect(300, 0, 60, 480)) = 0;
  EXPECT_TRUE(listed(path::further_readings(holed.frame(), 12), Reading::kMeasured));
}

TEST(FurtherReadings, OfALargeMaskAreAsFewAsItsPixelsAllow) {
  Canvas canvas(4096, 4096);
  canvas.stroke({{40, 40}, {4000, 4000}}, 60);
  EXPECT_EQ(path::further_readings(canvas.frame(), 60), std::vector{Reading::kHalved});
}

TEST(FurtherReadings, NeverRepeatTheFirst) {
  const Canvas canvas = painted(wave(60, 560), 12);
  EXPECT_FALSE(listed(path::further_readings(canvas.frame(), 5), Reading::kAsGiven));
}

}  // namespace
}  // namespace flowdlo::test
