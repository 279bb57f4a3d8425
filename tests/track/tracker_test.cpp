// Tracker, from frames to numbered ropes.
#include "flowdlo/tracker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <utility>

#include "geometry/polyline.hpp"
#include "scene/ropes.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo {
namespace {

using lab::make_ropes;
using lab::RopesKind;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::WaveFrame;

Config config(int ropes) {
  Config config{.weights = FLOWDLO_WEIGHTS, .device = "cpu"};
  config.field_weights = FLOWDLO_FIELD_WEIGHTS;
  config.ropes = ropes;
  config.threads = 1;
  return config;
}

Tracker make(int ropes, const TrackerConfig& tracking = {}) {
  auto tracker = Tracker::create(config(ropes), tracking);
  if (!tracker) throw std::runtime_error(tracker.error().message);
  return *std::move(tracker);
}

/// Every image moved to the right.
lab::RopesScene moved(lab::RopesScene scene, int columns) {
  auto& image = scene.image;
  const auto move = [&](auto& pixels, int channels) {
    const auto from = pixels;
    for (int v = 0; v < image.height; ++v) {
      for (int u = 0; u < image.width; ++u) {
        const int source = std::max(0, u - columns);
        for (int c = 0; c < channels; ++c) {
          pixels[static_cast<std::size_t>((v * image.width + u) * channels + c)] =
              from[static_cast<std::size_t>((v * image.width + source) * channels + c)];
        }
      }
    }
  };
  move(image.depth_m, 1);
  move(image.mask, 1);
  move(image.instances, 1);
  move(image.color_bgr, 3);
  return scene;
}

TEST(Tracker, RopesThatMoveKeepNumbersAndEnds) {
  const auto scene = make_ropes(RopesKind::kCrossing, 3, 0);
  Tracker tracker = make(0);
  const auto first = tracker.estimate_ropes(scene.frame());
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_THAT(first->numbers, ElementsAre(1, 2, 3));
  const auto later = moved(scene, 12);
  const auto second = tracker.estimate_ropes(later.frame());
  ASSERT_TRUE(second) << second.error().message;
  ASSERT_THAT(second->numbers, ElementsAre(1, 2, 3));
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& before = first->found.ropes[i].nodes;
    const auto& now = second->found.ropes[i].nodes;
    EXPECT_LT(geometry::mean_distance(before, now), 0.03) << i;
    EXPECT_LT(geometry::distance(before.front(), now.front()),
              geometry::distance(before.front(), now.back()))
        << i;
  }
}

TEST(Tracker, ARopeThatIsHiddenForAFrameComesBackWithItsNumber) {
  const auto scene = make_ropes(RopesKind::kCrossing, 3, 0);
  auto hidden = scene;
  for (std::size_t p = 0; p < hidden.image.mask.size(); ++p) {
    if (hidden.image.instances[p] == 1) hidden.image.mask[p] = 0;
  }
  Tracker tracker = make(0);
  const auto first = tracker.estimate_ropes(scene.frame());
  ASSERT_TRUE(first) << first.error().message;
  const auto second = tracker.estimate_ropes(hidden.frame());
  ASSERT_TRUE(second) << second.error().message;
  ASSERT_EQ(second->numbers.size(), 2U);
  ASSERT_EQ(second->missing.size(), 1U);
  const auto third = tracker.estimate_ropes(scene.frame());
  ASSERT_TRUE(third) << third.error().message;
  EXPECT_EQ(third->numbers, first->numbers);
  EXPECT_TRUE(third->missing.empty());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(third->found.ropes[i].nodes, first->found.ropes[i].nodes);
  }
}

TEST(Tracker, OneRopeIsEstimatedByHeedOfTheFrameBefore) {
  const WaveFrame wave;
  auto tracker = make(1);
  Hints other_end;
  const auto alone = tracker.estimate(wave.frame());
  ASSERT_TRUE(alone) << alone.error().message;
  tracker.forget();
  other_end.first_end = alone->nodes.back();
  const auto turned = tracker.estimate(wave.frame(), other_end);
  ASSERT_TRUE(turned) << turned.error().message;
  EXPECT_TRUE(turned->reversed);
  const auto next = tracker.estimate(wave.frame());
  ASSERT_TRUE(next) << next.error().message;
  EXPECT_EQ(next->nodes, turned->nodes);
  tracker.forget();
  const auto anew = tracker.estimate(wave.frame());
  ASSERT_TRUE(anew) << anew.error().message;
  EXPECT_EQ(anew->nodes, alone->nodes);
}

TEST(Tracker, AFrameThatFailsLeavesTheOneBefore) {
  const WaveFrame wave;
  WaveFrame empty;
  std::fill(empty.mask.begin(), empty.mask.end(), std::uint8_t{0});
  auto tracker = make(1, {.patience = 1});
  Hints hints;
  const auto plain = tracker.estimate(wave.frame());
  ASSERT_TRUE(plain) << plain.error().message;
  hints.first_end = plain->nodes.back();
  const auto turned = tracker.estimate(wave.frame(), hints);
  ASSERT_TRUE(turned) << turned.error().message;
  EXPECT_FALSE(tracker.estimate(empty.frame()));
  const auto after_one = tracker.estimate(wave.frame());
  ASSERT_TRUE(after_one) << after_one.error().message;
  EXPECT_EQ(after_one->nodes, turned->nodes);
  EXPECT_FALSE(tracker.estimate(empty.frame()));
  EXPECT_FALSE(tracker.estimate(empty.frame()));
  const auto after_two = tracker.estimate(wave.frame());
  ASSERT_TRUE(after_two) << after_two.error().message;
  EXPECT_EQ(after_two->nodes, plain->nodes);
}

TEST(Tracker, AFrameWithoutRopesFailsAndIsRemembered) {
  const auto scene = make_ropes(RopesKind::kCrossing, 2, 0);
  auto empty = scene;
  std::fill(empty.image.mask.begin(), empty.image.mask.end(), std::uint8_t{0});
  auto tracker = make(0, {.patience = 0});
  ASSERT_TRUE(tracker.estimate_ropes(scene.frame()));
  const auto none = tracker.estimate_ropes(empty.frame());
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kNoPath);
  const auto back = tracker.estimate_ropes(scene.frame());
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_THAT(back->numbers, ElementsAre(3, 4));
}

TEST(Tracker, FaultsAreNamed) {
  const TrackerConfig bad{.most_moved_m = std::numeric_limits<double>::quiet_NaN(), .patience = -1};
  const auto refused = Tracker::create(config(1), bad);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(refused.error().message, HasSubstr("TrackerConfig.most_moved_m"));
  EXPECT_THAT(refused.error().message, HasSubstr("TrackerConfig.patience"));
}

TEST(Tracker, WhatWasMovedFromFailsAndCrashesNothing) {
  const WaveFrame wave;
  Tracker tracker = make(1);
  Tracker taken = std::move(tracker);
  // NOLINTNEXTLINE(bugprone-use-after-move): that is what is tested
  EXPECT_FALSE(tracker.estimate(wave.frame()));
  EXPECT_FALSE(tracker.estimate_ropes(wave.frame()));
  EXPECT_EQ(tracker.estimator(), nullptr);
  tracker.forget();
  ASSERT_NE(taken.estimator(), nullptr);
  Estimator gone = std::move(*taken.estimator());
  EXPECT_FALSE(taken.estimate(wave.frame()));
  const auto again = Tracker::create(std::move(*taken.estimator()));
  ASSERT_FALSE(again);
  EXPECT_THAT(again.error().message, HasSubstr("moved from"));
}

}  // namespace
}  // namespace flowdlo
