#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "synth/laid_rope.hpp"
#include "synth/rope.hpp"
#include "synth/synthetic_frame.hpp"

namespace flowdlo::synth {
namespace {

SyntheticFrame several(std::uint64_t index, const Render& render = {.color = false}) {
  auto frame = make_frame(Split::kSeveral, Part::kTraining, 7, index, render);
  EXPECT_TRUE(frame) << frame.error().message;
  return frame ? std::move(*frame) : SyntheticFrame{};
}

TEST(SeveralRopes, AreTwoToNineLongestFirstAndEachWithItsLabel) {
  std::set<std::string> scenarios;
  for (std::uint64_t index = 0; index < 12; ++index) {
    const auto frame = several(index, {.color = false, .dense = true});
    const std::size_t count = frame.ropes.size();
    scenarios.insert(frame.meta.scenario);
    ASSERT_GE(count, 2U);
    ASSERT_LE(count, 9U);
    EXPECT_EQ(frame.meta.ropes, static_cast<int>(count));
    ASSERT_EQ(frame.dense->curves.size(), count);
    std::set<int> labels;
    for (std::size_t i = 0; i < frame.folder.instances.size(); ++i) {
      const int label = frame.folder.instances[i];
      EXPECT_EQ(label > 0, frame.dense->mask[i] > 0);
      if (label > 0) labels.insert(label);
    }
    EXPECT_EQ(labels.size(), count);
    EXPECT_EQ(*labels.rbegin(), static_cast<int>(count));
    for (std::size_t k = 1; k < count; ++k) {
      EXPECT_GE(frame.dense->curves[k - 1].length_m(), frame.dense->curves[k].length_m());
    }
  }
  EXPECT_GE(scenarios.size(), 4U);
}

TEST(SeveralRopes, AreTheSameEveryTimeAndShareNoNumbersWithOtherSplits) {
  for (const Split split : {Split::kSeveral, Split::kTangled}) {
    const auto first = make_frame(split, Part::kTraining, 7, 3);
    const auto again = make_frame(split, Part::kTraining, 7, 3);
    ASSERT_TRUE(first) << first.error().message;
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(first->folder.color_bgr, again->folder.color_bgr);
    EXPECT_EQ(first->folder.depth_m, again->folder.depth_m);
    EXPECT_EQ(first->folder.mask, again->folder.mask);
  }
  std::set<std::uint64_t> streams;
  for (const Split split : {Split::kThesis, Split::kWide, Split::kSeveral, Split::kTangled}) {
    for (const Use use : {Use::kScenario, Use::kRope, Use::kView, Use::kThings, Use::kSensor,
                          Use::kMask, Use::kLook}) {
      for (const int frame : {0, 1}) {
        streams.insert(Dice::stream_of({split, Part::kTraining, 0, 0}, use, frame));
        streams.insert(Dice::stream_of({split, Part::kValidation, 0, 0}, use, frame));
      }
    }
  }
  EXPECT_EQ(streams.size(), 4U * 7U * 2U * 2U);
}

TEST(SeveralRopes, NoneRunsThroughAnother) {
  for (std::uint64_t index = 0; index < 8; ++index) {
    const auto frame = several(index, {.color = false, .dense = true});
    const auto& curves = frame.dense->curves;
    for (std::size_t a = 0; a < curves.size(); ++a) {
      for (std::size_t b = a + 1; b < curves.size(); ++b) {
        const double sum = frame.ropes[a].radius_m + frame.ropes[b].radius_m;
        EXPECT_GE(distance_m(curves[a], curves[b], sum), 0.97 * sum) << index;
      }
    }
  }
}

TEST(SeveralRopes, ARingEndsWhereItBegins) {
  Dice dice({Split::kSeveral, Part::kTraining, 1, 0}, Use::kRope);
  std::optional<Ropes> ropes;
  for (int k = 0; k < 200 && !ropes; ++k) ropes = try_several_ropes("ropes-ring", dice);
  ASSERT_TRUE(ropes);
  const auto ring =
      std::find_if(ropes->begin(), ropes->end(), [](const Rope& rope) { return rope.closed; });
  ASSERT_NE(ring, ropes->end());
  EXPECT_LT((ring->curve.points.front() - ring->curve.points.back()).norm(), 1e-9);
  EXPECT_FALSE(ring->square_ends);
}

// A straight rope along x at y, from -0.1 to 0.1 m; turned by `turn`.
FlatRope straight(double radius_m, double turn) {
  FlatRope rope;
  rope.gauge.radius_m = radius_m;
  for (int i = -100; i <= 100; ++i) {
    rope.points.emplace_back(0.001 * i * Vector2d(std::cos(turn), std::sin(turn)));
  }
  return rope;
}

TEST(SeveralRopes, ARingAloneLiesThereWithoutTheOthers) {
  int rings = 0;
  for (std::uint64_t index = 0; index < 12; ++index) {
    const auto scenario = scenario_of(Split::kSeveral, Part::kTraining, 7, index);
    ASSERT_TRUE(scenario);
    if (*scenario != "ropes-ring") continue;
    ++rings;
    const auto frame = several(index, {.color = false, .ring_alone = true});
    ASSERT_EQ(frame.ropes.size(), 1U);
    EXPECT_TRUE(frame.ropes.front().closed);
    EXPECT_EQ(frame.meta.ropes, 1);
    const auto& labels = frame.folder.instances;
    EXPECT_EQ(*std::max_element(labels.begin(), labels.end()), 1);
  }
  EXPECT_GE(rings, 1);
}

TEST(LaidTogether, TheLaterRopeLiesOnTheEarlierOneWhateverTheirWidths) {
  Dice dice({Split::kSeveral, Part::kTraining, 1, 0}, Use::kRope);
  for (const double radius_m : {0.002, 0.004, 0.007}) {
    const std::vector<FlatRope> ropes{straight(0.004, 0), straight(radius_m, 1.2)};
    const auto curves = laid_together(ropes, {.in_order = true}, dice);
    ASSERT_TRUE(curves);
    const double sum = 0.004 + radius_m;
    EXPECT_GE(distance_m((*curves)[0], (*curves)[1], 2 * sum), 0.99 * sum);
    const auto height = [](const Curve& curve) {
      return curve.points[curve.points.size() / 2].z();
    };
    EXPECT_NEAR(height((*curves)[0]), 0.004, 1e-6);  // on the table
    EXPECT_GE(height((*curves)[1]) - height((*curves)[0]), sum);
    EXPECT_LT(height((*curves)[1]) - height((*curves)[0]), 1.2 * sum);
  }
}

TEST(Crossings, OfTwoLinesAreToldAlongBoth) {
  const auto a = straight(0.004, 0).points;
  const auto b = straight(0.004, 0.5).points;
  const auto found = crossings(a, b);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].first, 100, 1.01);
  EXPECT_NEAR(found[0].second, 100, 1.01);
  EXPECT_NEAR(found[0].sine, std::sin(0.5), 1e-6);
}

}  // namespace
}  // namespace flowdlo::synth
