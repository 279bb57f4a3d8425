#include "tip_fit/sample.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "strand/scene_range.hpp"
#include "synth/drawn_frame.hpp"
#include "synth/synthetic_frame.hpp"

namespace flowdlo::lab {
namespace {

constexpr std::uint64_t kCrossingRopes = 105;  // two that cross in plain sight

/// An arc of a tenth of a metre's radius between two angles.
Centerline arc(float from, float to) {
  Centerline nodes{};
  for (std::size_t i = 0; i < kNodes; ++i) {
    const float angle = from + (to - from) * static_cast<float>(i) / (kNodes - 1);
    nodes[i] = {0.1F * std::cos(angle), 0.1F * std::sin(angle), 0.5F};
  }
  return nodes;
}

TEST(BeyondM, IsMeasuredAlongTheRope) {
  const auto truth = arc(0, 3);
  EXPECT_NEAR(*beyond_m(arc(0.4F, 3), truth, 0.01), 0.04, 0.001);  // the rope goes on around a bend
  EXPECT_NEAR(*beyond_m(arc(-0.3F, 3), truth, 0.01), -0.03, 0.001);  // it has ended before
  EXPECT_NEAR(*beyond_m(arc(0, 3), truth, 0.01), 0, 0.0005);
}

TEST(BeyondM, AnEndOnNothingOfTheRopeSaysNothing) {
  auto aside = arc(0, 3);
  for (auto& node : aside) node.z += 0.05F;
  EXPECT_FALSE(beyond_m(aside, arc(0, 3), 0.01));
}

TEST(TipSamples, OfADrawnRopeBothEndsLieNearItsTips) {
  auto network = strand::one_network(FLOWDLO_FIELD_WEIGHTS);
  ASSERT_TRUE(network);
  const auto samples = samples_of(synth::drawn_frame(Kind::kOneCrossing, 5, true), *network);
  ASSERT_GE(samples.size(), 2U);
  for (const TipSample& sample : samples) {
    EXPECT_LT(std::abs(sample.beyond_widths), 1);
    EXPECT_EQ(sample.features[refine::kTipOne], 1);
    EXPECT_GT(sample.features[refine::kTipAhead], 0.3F);  // in plain sight
  }
}

TEST(TipSamples, OfSeveralRopesEachsEndsLieNearItsTips) {
  auto network = strand::one_network(FLOWDLO_FIELD_WEIGHTS);
  ASSERT_TRUE(network);
  const auto scene =
      synth::make_frame(synth::Split::kSeveral, synth::Part::kTraining, 0, kCrossingRopes);
  ASSERT_TRUE(scene);
  ASSERT_GE(scene->ropes.size(), 2U);
  const auto samples = samples_of_ropes(*scene, *network);
  ASSERT_GE(samples.size(), 2 * scene->ropes.size() - 1);
  for (const TipSample& sample : samples) {
    EXPECT_EQ(sample.index, kCrossingRopes);
    EXPECT_LT(std::abs(sample.beyond_widths), 4);
  }
}

}  // namespace
}  // namespace flowdlo::lab
