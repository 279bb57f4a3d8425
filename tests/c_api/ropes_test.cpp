// Several ropes and hints through the C interface: the same bits as through the C++ one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <vector>

#include "c_api/c_values.hpp"
#include "flowdlo/estimator.hpp"
#include "flowdlo/flowdlo.h"
#include "flowdlo/tracker.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo {
namespace {

using testing::c_frame;
using testing::empty_estimate;
using testing::Handle;
using ::testing::HasSubstr;
using testing::WaveFrame;

/// One wave below another.
struct TwoWaves {
  int width;
  int height;
  Intrinsics camera;
  std::vector<float> depth_m;
  std::vector<std::uint8_t> mask;

  TwoWaves() {
    const WaveFrame wave;
    width = wave.width;
    height = 2 * wave.height;
    camera = wave.camera;
    camera.cy = 0.5F * static_cast<float>(height - 1);
    for (int i = 0; i < 2; ++i) {
      depth_m.insert(depth_m.end(), wave.depth_m.begin(), wave.depth_m.end());
      mask.insert(mask.end(), wave.mask.begin(), wave.mask.end());
    }
  }

  [[nodiscard]] Frame frame() const { return {width, height, camera, depth_m, mask, {}}; }
};

Handle make(int ropes) {
  flowdlo_config config;
  flowdlo_estimator* estimator = nullptr;
  if (flowdlo_config_init(&config, sizeof(config)) != FLOWDLO_OK || config.ropes != 1) {
    throw std::runtime_error("flowdlo_config_init");
  }
  config.weights = FLOWDLO_WEIGHTS;
  config.device = "cpu";
  config.euler_steps = 1;
  config.draws = 1;
  config.ropes = ropes;
  if (flowdlo_estimator_create(&config, &estimator) != FLOWDLO_OK) {
    throw std::runtime_error(flowdlo_last_error());
  }
  return Handle(estimator);
}

Estimator make_cpp(int ropes) {
  auto estimator = Estimator::create(
      {.weights = FLOWDLO_WEIGHTS, .device = "cpu", .euler_steps = 1, .draws = 1, .ropes = ropes});
  if (!estimator) throw std::runtime_error(estimator.error().message);
  return *std::move(estimator);
}

flowdlo_hints no_hints() {
  flowdlo_hints hints;
  EXPECT_EQ(flowdlo_hints_init(&hints, sizeof(hints)), FLOWDLO_OK);
  return hints;
}

bool same_nodes(const flowdlo_estimate& c, const Centerline& nodes) {
  return std::memcmp(c.nodes, nodes.data(), sizeof(c.nodes)) == 0;
}

TEST(CRopes, SeveralAreThoseOfTheCppInterface) {
  const TwoWaves waves;
  auto reference = make_cpp(0);
  const auto expected = reference.estimate_ropes(waves.frame());
  ASSERT_TRUE(expected) << expected.error().message;
  ASSERT_EQ(expected->ropes.size(), 2U);
  const Handle estimator = make(0);
  const flowdlo_frame frame = c_frame(waves.frame());

  int ropes = 0;
  int crossings = -1;
  ASSERT_EQ(flowdlo_estimator_estimate_ropes(estimator.get(), &frame, &ropes, &crossings),
            FLOWDLO_OK)
      << flowdlo_last_error();
  ASSERT_EQ(ropes, 2);
  EXPECT_EQ(crossings, static_cast<int>(expected->crossings.size()));
  for (int i = 0; i < ropes; ++i) {
    flowdlo_estimate rope = empty_estimate();
    ASSERT_EQ(flowdlo_estimator_rope(estimator.get(), i, &rope), FLOWDLO_OK);
    const Estimate& of_cpp = expected->ropes[static_cast<std::size_t>(i)];
    EXPECT_TRUE(same_nodes(rope, of_cpp.nodes)) << i;
    EXPECT_EQ(rope.confidence, of_cpp.confidence) << i;
  }
  std::vector<std::uint16_t> instances(waves.mask.size());
  ASSERT_EQ(flowdlo_estimator_instances(estimator.get(), instances.data(), instances.size()),
            FLOWDLO_OK);
  EXPECT_EQ(instances, expected->instances);
}

TEST(CRopes, WhereOnePassesOverTheOtherIsThatOfTheCppInterface) {
  WaveFrame wave;
  std::fill(wave.mask.begin(), wave.mask.end(), std::uint8_t{0});
  std::fill(wave.depth_m.begin(), wave.depth_m.end(), 0.0F);
  const auto stroke = [&](float from_v, float to_v, float depth_m) {
    for (int u = 40; u < 280; ++u) {
      const float v = from_v + (to_v - from_v) * static_cast<float>(u - 40) / 240;
      for (int y = -4; y <= 4; ++y) {
        const auto pixel = (static_cast<std::size_t>(std::lround(v)) + y) * wave.width + u;
        wave.mask[pixel] = 255;
        wave.depth_m[pixel] = depth_m;
      }
    }
  };
  stroke(50, 190, 0.42F);
  stroke(190, 50, 0.38F);
  auto reference = make_cpp(2);
  const auto expected = reference.estimate_ropes(wave.frame());
  ASSERT_TRUE(expected) << expected.error().message;
  const Handle estimator = make(2);
  const flowdlo_frame frame = c_frame(wave.frame());

  int ropes = 0;
  int crossings = 0;
  ASSERT_EQ(flowdlo_estimator_estimate_ropes(estimator.get(), &frame, &ropes, &crossings),
            FLOWDLO_OK);
  ASSERT_GE(crossings, 1);
  ASSERT_EQ(crossings, static_cast<int>(expected->crossings.size()));
  flowdlo_crossing crossing;
  ASSERT_EQ(flowdlo_crossing_init(&crossing, sizeof(crossing)), FLOWDLO_OK);
  ASSERT_EQ(flowdlo_estimator_crossing(estimator.get(), 0, &crossing), FLOWDLO_OK);
  const RopeCrossing& of_cpp = expected->crossings.front();
  EXPECT_EQ(crossing.over, of_cpp.over);
  EXPECT_EQ(crossing.under, of_cpp.under);
  EXPECT_EQ(crossing.over_at_m, of_cpp.over_at_m);
  EXPECT_EQ(crossing.under_at_m, of_cpp.under_at_m);
  EXPECT_EQ(crossing.apart_m, of_cpp.apart_m);
}

TEST(CRopes, WhatIsAskedForAndNotThereIsAnError) {
  const Handle estimator = make(0);
  flowdlo_estimate rope = empty_estimate();
  EXPECT_EQ(flowdlo_estimator_rope(estimator.get(), 0, &rope), FLOWDLO_BAD_INPUT);
  EXPECT_THAT(flowdlo_last_error(), HasSubstr("below the 0 of the last"));
  const TwoWaves waves;
  const flowdlo_frame frame = c_frame(waves.frame());
  int ropes = 0;
  EXPECT_EQ(flowdlo_estimator_estimate_ropes(estimator.get(), &frame, nullptr, nullptr),
            FLOWDLO_BAD_INPUT);
  ASSERT_EQ(flowdlo_estimator_estimate_ropes(estimator.get(), &frame, &ropes, nullptr), FLOWDLO_OK);
  for (const int index : {-1, ropes}) {
    EXPECT_EQ(flowdlo_estimator_rope(estimator.get(), index, &rope), FLOWDLO_BAD_INPUT) << index;
    flowdlo_crossing crossing{};
    crossing.struct_size = sizeof(crossing);
    EXPECT_EQ(flowdlo_estimator_crossing(estimator.get(), index, &crossing), FLOWDLO_BAD_INPUT);
  }
  std::vector<std::uint16_t> instances(waves.mask.size());
  EXPECT_EQ(flowdlo_estimator_instances(estimator.get(), instances.data(), instances.size() - 1),
            FLOWDLO_BAD_INPUT);
  EXPECT_EQ(flowdlo_estimator_instances(estimator.get(), nullptr, instances.size()),
            FLOWDLO_BAD_INPUT);
  EXPECT_EQ(flowdlo_estimator_estimate(estimator.get(), nullptr, &rope), FLOWDLO_BAD_INPUT);
  EXPECT_EQ(flowdlo_estimator_rope(estimator.get(), 0, &rope), FLOWDLO_BAD_INPUT)
      << "a later estimate forgets them";
}

TEST(CRopes, LabelsTellWhichPixelIsWhose) {
  const TwoWaves waves;
  std::vector<std::uint16_t> labels(waves.mask.size(), 0);
  for (std::size_t p = 0; p < labels.size(); ++p) {
    if (waves.mask[p] > 127) labels[p] = p < labels.size() / 2 ? 7 : 4;
  }
  Frame of_cpp = waves.frame();
  of_cpp.instances = labels;
  auto reference = make_cpp(1);
  const auto expected = reference.estimate_ropes(of_cpp);
  ASSERT_TRUE(expected) << expected.error().message;
  ASSERT_EQ(expected->ropes.size(), 2U);
  // As two channels, of which the second is none of ours.
  std::vector<std::uint16_t> spread(2 * labels.size(), 9);
  for (std::size_t p = 0; p < labels.size(); ++p) spread[2 * p] = labels[p];
  const Handle estimator = make(1);
  for (const bool packed : {true, false}) {
    flowdlo_frame frame = c_frame(waves.frame());
    frame.instances = packed ? flowdlo_image{labels.data(), 0, 0, FLOWDLO_PIXEL_U16, 0}
                             : flowdlo_image{spread.data(), 0, 4, FLOWDLO_PIXEL_U16, 0};
    int ropes = 0;
    ASSERT_EQ(flowdlo_estimator_estimate_ropes(estimator.get(), &frame, &ropes, nullptr),
              FLOWDLO_OK)
        << flowdlo_last_error();
    ASSERT_EQ(ropes, 2);
    for (int i = 0; i < ropes; ++i) {
      flowdlo_estimate rope = empty_estimate();
      ASSERT_EQ(flowdlo_estimator_rope(estimator.get(), i, &rope), FLOWDLO_OK);
      EXPECT_TRUE(same_nodes(rope, expected->ropes[static_cast<std::size_t>(i)].nodes)) << i;
    }
  }
  flowdlo_frame wrong = c_frame(waves.frame());
  wrong.instances = {labels.data(), 0, 0, FLOWDLO_PIXEL_U8, 0};
  int ropes = 0;
  EXPECT_EQ(flowdlo_estimator_estimate_ropes(estimator.get(), &wrong, &ropes, nullptr),
            FLOWDLO_BAD_INPUT);
  EXPECT_THAT(flowdlo_last_error(), HasSubstr("flowdlo_frame.instances.pixel"));
}

TEST(CHints, TheFrameBeforeKeepsTheOrderOfTheEnds) {
  const WaveFrame wave;
  const Handle estimator = make(1);
  const flowdlo_frame frame = c_frame(wave.frame());
  flowdlo_estimate first = empty_estimate();
  ASSERT_EQ(flowdlo_estimator_estimate_with_hints(estimator.get(), &frame, nullptr, &first),
            FLOWDLO_OK);
  float turned[FLOWDLO_NODES][3];
  for (int node = 0; node < FLOWDLO_NODES; ++node) {
    std::memcpy(turned[node], first.nodes[FLOWDLO_NODES - 1 - node], sizeof(turned[node]));
  }
  flowdlo_hints hints = no_hints();
  hints.previous = &turned[0][0];

  flowdlo_estimate second = empty_estimate();
  ASSERT_EQ(flowdlo_estimator_estimate_with_hints(estimator.get(), &frame, &hints, &second),
            FLOWDLO_OK);
  EXPECT_EQ(std::memcmp(second.nodes, turned, sizeof(turned)), 0);
}

TEST(CHints, AnEndIsAPixelOfTheWholeImagesOrAPoint) {
  const WaveFrame wave;
  const Handle estimator = make(1);
  flowdlo_frame frame = c_frame(wave.frame());
  frame.roi_u = 10;
  frame.roi_v = 20;
  frame.roi_width = wave.width - 10;
  frame.roi_height = wave.height - 30;
  flowdlo_estimate plain = empty_estimate();
  ASSERT_EQ(flowdlo_estimator_estimate(estimator.get(), &frame, &plain), FLOWDLO_OK);
  const float* last = plain.nodes[FLOWDLO_NODES - 1];
  flowdlo_hints by_pixel = no_hints();
  by_pixel.first_end = {FLOWDLO_PLACE_PIXEL,
                        {wave.camera.fx * last[0] / last[2] + wave.camera.cx,
                         wave.camera.fy * last[1] / last[2] + wave.camera.cy, 0}};
  flowdlo_hints by_point = no_hints();
  by_point.first_end = {FLOWDLO_PLACE_POINT, {last[0], last[1], last[2]}};
  for (const flowdlo_hints* hints : {&by_pixel, &by_point}) {
    flowdlo_estimate turned = empty_estimate();
    ASSERT_EQ(flowdlo_estimator_estimate_with_hints(estimator.get(), &frame, hints, &turned),
              FLOWDLO_OK)
        << flowdlo_last_error();
    EXPECT_EQ(std::memcmp(turned.nodes[0], last, sizeof(turned.nodes[0])), 0);
  }
}

TEST(CHints, WhatCannotBeIsNamed) {
  const WaveFrame wave;
  const Handle estimator = make(1);
  const flowdlo_frame frame = c_frame(wave.frame());
  flowdlo_estimate estimate = empty_estimate();
  flowdlo_hints hints = no_hints();
  hints.ends[1].kind = 7;
  EXPECT_EQ(flowdlo_estimator_estimate_with_hints(estimator.get(), &frame, &hints, &estimate),
            FLOWDLO_BAD_INPUT);
  EXPECT_THAT(flowdlo_last_error(), HasSubstr("flowdlo_hints.ends.kind: expected one of"));
  hints = no_hints();
  hints.rope_length_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(flowdlo_estimator_estimate_with_hints(estimator.get(), &frame, &hints, &estimate),
            FLOWDLO_BAD_INPUT);
  EXPECT_THAT(flowdlo_last_error(), HasSubstr("rope_length_m"));
  hints = no_hints();
  hints.closed = 2;
  EXPECT_EQ(flowdlo_estimator_estimate_with_hints(estimator.get(), &frame, &hints, &estimate),
            FLOWDLO_BAD_INPUT);
  EXPECT_THAT(flowdlo_last_error(), HasSubstr("flowdlo_hints.closed: expected 1, -1 or 0, got 2"));
  hints.closed = 1;
  hints.ends[0] = {FLOWDLO_PLACE_PIXEL, {10, 10, 0}};
  EXPECT_EQ(flowdlo_estimator_estimate_with_hints(estimator.get(), &frame, &hints, &estimate),
            FLOWDLO_BAD_INPUT);
  EXPECT_THAT(flowdlo_last_error(), HasSubstr("Hints.ends: expected none"));
  hints.struct_size = 3;
  EXPECT_EQ(flowdlo_estimator_estimate_with_hints(estimator.get(), &frame, &hints, &estimate),
            FLOWDLO_BAD_INPUT);
  EXPECT_THAT(flowdlo_last_error(), HasSubstr("flowdlo_hints_init"));
}

TEST(CTracking, RopesKeepTheirNumbersAndTheOrderOfTheirEnds) {
  const TwoWaves both;
  TwoWaves lower;
  std::fill(lower.mask.begin(), lower.mask.begin() + lower.width * lower.height / 2,
            std::uint8_t{0});
  const Handle estimator = make(0);
  int ropes = 0;
  int missing = -1;
  int number = 0;
  flowdlo_frame frame = c_frame(both.frame());
  ASSERT_EQ(flowdlo_estimator_track_ropes(estimator.get(), &frame, &ropes, nullptr, &missing),
            FLOWDLO_OK)
      << flowdlo_last_error();
  ASSERT_EQ(ropes, 2);
  EXPECT_EQ(missing, 0);
  flowdlo_estimate first = empty_estimate();
  int of_lower = -1;
  for (int i = 0; i < ropes; ++i) {
    flowdlo_estimate rope = empty_estimate();
    ASSERT_EQ(flowdlo_estimator_rope(estimator.get(), i, &rope), FLOWDLO_OK);
    ASSERT_EQ(flowdlo_estimator_rope_number(estimator.get(), i, &number), FLOWDLO_OK);
    EXPECT_EQ(number, i + 1);
    if (rope.nodes[0][1] < 0) continue;
    first = rope;
    of_lower = number;
  }
  frame = c_frame(lower.frame());
  ASSERT_EQ(flowdlo_estimator_track_ropes(estimator.get(), &frame, &ropes, nullptr, &missing),
            FLOWDLO_OK);
  ASSERT_EQ(ropes, 1);
  ASSERT_EQ(missing, 1);
  ASSERT_EQ(flowdlo_estimator_rope_number(estimator.get(), 0, &number), FLOWDLO_OK);
  EXPECT_EQ(number, of_lower);
  ASSERT_EQ(flowdlo_estimator_missing_rope(estimator.get(), 0, &number), FLOWDLO_OK);
  EXPECT_EQ(number, 3 - of_lower);
  flowdlo_estimate second = empty_estimate();
  ASSERT_EQ(flowdlo_estimator_rope(estimator.get(), 0, &second), FLOWDLO_OK);
  EXPECT_EQ((second.nodes[0][0] < second.nodes[63][0]), (first.nodes[0][0] < first.nodes[63][0]));
  ASSERT_EQ(flowdlo_estimator_forget(estimator.get()), FLOWDLO_OK);
  ASSERT_EQ(flowdlo_estimator_track_ropes(estimator.get(), &frame, &ropes, nullptr, nullptr),
            FLOWDLO_OK);
  ASSERT_EQ(flowdlo_estimator_rope_number(estimator.get(), 0, &number), FLOWDLO_OK);
  EXPECT_EQ(number, 3);
}

TEST(CTracking, OneRopeIsEstimatedByHeedOfTheFrameBefore) {
  const WaveFrame wave;
  const Handle estimator = make(1);
  const flowdlo_frame frame = c_frame(wave.frame());
  flowdlo_estimate plain = empty_estimate();
  ASSERT_EQ(flowdlo_estimator_estimate(estimator.get(), &frame, &plain), FLOWDLO_OK);
  const float* last = plain.nodes[FLOWDLO_NODES - 1];
  flowdlo_hints hints = no_hints();
  hints.first_end = {FLOWDLO_PLACE_POINT, {last[0], last[1], last[2]}};
  flowdlo_estimate turned = empty_estimate();
  ASSERT_EQ(flowdlo_estimator_track(estimator.get(), &frame, &hints, &turned), FLOWDLO_OK);
  flowdlo_estimate next = empty_estimate();
  ASSERT_EQ(flowdlo_estimator_track(estimator.get(), &frame, nullptr, &next), FLOWDLO_OK);
  EXPECT_EQ(std::memcmp(next.nodes, turned.nodes, sizeof(next.nodes)), 0);
  EXPECT_NE(std::memcmp(next.nodes, plain.nodes, sizeof(next.nodes)), 0);
}

TEST(CTracking, WhatCannotBeIsNamed) {
  const Handle estimator = make(1);
  flowdlo_tracking tracking;
  ASSERT_EQ(flowdlo_tracking_init(&tracking, sizeof(tracking)), FLOWDLO_OK);
  EXPECT_EQ(tracking.most_moved_m, TrackerConfig{}.most_moved_m);
  EXPECT_EQ(tracking.patience, TrackerConfig{}.patience);
  EXPECT_EQ(flowdlo_estimator_set_tracking(estimator.get(), &tracking), FLOWDLO_OK);
  tracking.most_moved_m = 0;
  EXPECT_EQ(flowdlo_estimator_set_tracking(estimator.get(), &tracking), FLOWDLO_BAD_INPUT);
  EXPECT_THAT(flowdlo_last_error(), HasSubstr("most_moved_m: expected metres over 0"));
  tracking.struct_size = 3;
  EXPECT_EQ(flowdlo_estimator_set_tracking(estimator.get(), &tracking), FLOWDLO_BAD_INPUT);
  EXPECT_THAT(flowdlo_last_error(), HasSubstr("flowdlo_tracking_init"));
  int number = 0;
  EXPECT_EQ(flowdlo_estimator_rope_number(estimator.get(), 0, &number), FLOWDLO_BAD_INPUT);
  EXPECT_THAT(flowdlo_last_error(), HasSubstr("below the 0 of the last"));
  EXPECT_EQ(flowdlo_estimator_missing_rope(estimator.get(), 0, nullptr), FLOWDLO_BAD_INPUT);
  EXPECT_EQ(flowdlo_estimator_forget(nullptr), FLOWDLO_BAD_INPUT);
}

}  // namespace
}  // namespace flowdlo
