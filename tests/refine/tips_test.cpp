#include "refine/tips.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "field/strand_field.hpp"
#include "geometry/camera.hpp"
#include "geometry/polyline.hpp"
#include "reference/program.hpp"
#include "refine/refined.hpp"
#include "support/straight_rope.hpp"

namespace flowdlo::refine {
namespace {

using testing::StraightRope;

std::size_t feature(TipPlane plane, std::size_t aside, std::size_t place) {
  return kTipColumns + (plane * kTipAsides + aside) * kTipPlaces + place;
}

/// Says `unit_asinh` of every end, and more of one feature where `weight` is not 0.
weights::TipWeights says(float always, std::size_t of = 0, float weight = 0) {
  auto tips = weights::seeded_tips(1);
  for (auto& tensor : tips.tensors) std::fill(tensor.values.begin(), tensor.values.end(), 0.0F);
  tips.tensors.back().values[kTipOne] = always;
  tips.tensors.back().values[of] += weight;
  return tips;
}

/// A network that moves no node deep or aside.
Network moves_ends(const weights::TipWeights& tips) {
  auto weights = weights::seeded_refine(1);
  for (auto& tensor : weights.tensors) std::fill(tensor.values.begin(), tensor.values.end(), 0.0F);
  auto network = Network::create(
      weights, [] { return reference::create_program(1); }, tips);
  if (!network) throw std::runtime_error(network.error().message);
  return *std::move(network);
}

TEST(TipFeatures, SayWhereMaskAndDepthEnd) {
  const StraightRope rope;
  const field::FieldView nothing;
  for (const bool last : {false, true}) {
    const auto features = tip_features(rope.curve(), last, rope.frame(), nothing);
    EXPECT_EQ(features[kTipOne], 1);
    EXPECT_NEAR(features[kTipWidth], 0.5F * std::log2(10.0F / 8), 0.01F);
    EXPECT_NEAR(features[kTipSlope], 0.23F, 0.02F);  // the ends lie 13 degrees off the middle
    EXPECT_NEAR(features[kTipForeshort], 1, 0.01F);
    EXPECT_EQ(features[kTipUnsupported], 0);
    EXPECT_EQ(features[kTipAhead], 0);
    for (std::size_t aside = 0; aside < kTipAsides; ++aside) {
      // Places lie 5 px apart, the fourth at the end itself.
      // Half a width beside the axis is its edge: within the mask on one side.
      EXPECT_EQ(features[feature(kTipMasked, aside, 0)], 1 - 0.5F * static_cast<float>(aside));
      EXPECT_EQ(features[feature(kTipMasked, aside, 6)], 0);
      EXPECT_EQ(features[feature(kTipMeasured, aside, 6)], 1);
    }
    // What shows of the rope is a radius nearer than its axis, the table a radius deeper.
    EXPECT_NEAR(features[feature(kTipDeeper, 0, 0)], 0.5F * std::asinh(-1.0F), 0.01F);
    EXPECT_NEAR(features[feature(kTipDeeper, 0, 8)], 0.5F * std::asinh(1.0F), 0.01F);
    EXPECT_EQ(features[feature(kTipRope, 0, 0)], 0);
  }
}

TEST(TipFeatures, BothEndsOfASymmetricRopeAreAlike) {
  const StraightRope rope;
  const auto first = tip_features(rope.curve(), false, rope.frame(), {});
  const auto last = tip_features(rope.curve(), true, rope.frame(), {});
  for (std::size_t i = 0; i < kTipColumns; ++i) EXPECT_NEAR(first[i], last[i], 0.02F) << i;
}

TEST(TipFeatures, OutsideTheImageNothingIsMeasured) {
  const StraightRope rope;
  auto curve = rope.curve();
  for (auto& node : curve.nodes) node.x -= 45 * StraightRope::kAxis_m / 500;  // to 5 px beyond it
  const auto features = tip_features(curve, false, rope.frame(), {});
  EXPECT_EQ(features[feature(kTipMeasured, 0, 8)], -1);
  EXPECT_EQ(features[feature(kTipMasked, 0, 8)], 0);
}

TEST(TipFeatures, AreFiniteWhateverTheCurve) {
  const StraightRope rope;
  auto curve = rope.curve();
  curve.nodes.fill(curve.nodes[20]);
  curve.sigma_m.fill(0);
  curve.unseen_m.fill(std::numeric_limits<float>::infinity());
  for (const float value : tip_features(curve, true, rope.frame(), {})) {
    EXPECT_TRUE(std::isfinite(value));
  }
}

TEST(TipNetwork, SaysWidthsWithinWhatATipIsLookedFor) {
  const auto beyond = [](const weights::TipWeights& tips) {
    TipFeatures features{};
    features[kTipOne] = 1;
    return TipNetwork(tips).beyond(features);
  };
  EXPECT_NEAR(beyond(says(std::asinh(0.5F / kTipUnit))), 0.5F, 1e-6F);
  EXPECT_NEAR(beyond(says(std::asinh(-0.25F / kTipUnit))), -0.25F, 1e-6F);
  EXPECT_EQ(beyond(says(100)), kMostBeyond);
  EXPECT_EQ(beyond(says(-100)), -kMostBefore);
  EXPECT_EQ(beyond(says(std::numeric_limits<float>::quiet_NaN())), 0);
}

TEST(ToTheTips, AStraightRopeGetsLongerAtBothEnds) {
  const StraightRope rope;
  const auto before = rope.curve().nodes;
  const auto after = to_the_tips(before, {0.01F, 0.02F});
  EXPECT_NEAR(after.front().x, before.front().x - 0.01F, 1e-6F);
  EXPECT_NEAR(after.back().x, before.back().x + 0.02F, 1e-6F);
  EXPECT_NEAR(after.front().z, before.front().z, 1e-6F);
  EXPECT_NEAR(geometry::length(after), geometry::length(before) + 0.03F, 1e-5F);
  for (std::size_t i = 0; i + 1 < kNodes; ++i) {
    EXPECT_NEAR(after[i + 1].x - after[i].x, geometry::length(after) / (kNodes - 1), 1e-5F);
  }
}

TEST(ToTheTips, AnArcIsCutAlongItself) {
  Centerline arc{};
  for (std::size_t i = 0; i < kNodes; ++i) {
    const float angle = std::numbers::pi_v<float> * static_cast<float>(i) / (kNodes - 1);
    arc[i] = {0.1F * std::cos(angle), 0.1F * std::sin(angle), 0.5F};
  }
  const auto after = to_the_tips(arc, {-0.05F, -0.03F});
  EXPECT_NEAR(std::atan2(after.front().y, after.front().x), 0.5F, 0.01F);
  EXPECT_NEAR(std::atan2(after.back().y, after.back().x), std::numbers::pi_v<float> - 0.3F, 0.01F);
  for (const Point3& p : after) EXPECT_NEAR(std::hypot(p.x, p.y), 0.1F, 1e-4F);
}

TEST(ToTheTips, NoMoreThanAThirdIsCut) {
  const StraightRope rope;
  const auto before = rope.curve().nodes;
  const auto after = to_the_tips(before, {-10, -10});
  EXPECT_NEAR(geometry::length(after), 0.34F * geometry::length(before), 0.001F);
}

TEST(ToTheTips, NodesOnOnePointStayThere) {
  Centerline nodes{};
  nodes.fill({0.1F, 0.2F, 0.5F});
  for (const Point3& p : to_the_tips(nodes, {0.01F, -0.01F})) {
    EXPECT_EQ(p.x, 0.1F);
    EXPECT_EQ(p.z, 0.5F);
  }
}

TEST(Refined, EndsGoWhereTheNetworkOfTipsSaysBesideAField) {
  const StraightRope rope;
  const auto before = rope.curve().nodes;
  auto network = moves_ends(says(std::asinh(1.0F / kTipUnit)));
  const field::FieldView seen;
  const auto moved = refined(rope.curve(), rope.frame(), network, {&seen});
  ASSERT_TRUE(moved);
  for (const float m : moved->beyond_m) EXPECT_NEAR(m, 2 * StraightRope::kRadius_m, 1e-6F);
  EXPECT_NEAR(moved->nodes.front().x, before.front().x - 2 * StraightRope::kRadius_m, 1e-6F);
  EXPECT_NEAR(moved->nodes.back().x, before.back().x + 2 * StraightRope::kRadius_m, 1e-6F);

  const auto stayed = refined(rope.curve(), rope.frame(), network);
  ASSERT_TRUE(stayed);
  EXPECT_EQ(stayed->nodes.front().x, before.front().x);
  EXPECT_EQ(stayed->beyond_m[0], 0);
}

TEST(Refined, EachEndIsToldOfItself) {
  const StraightRope rope;
  auto curve = rope.curve();
  curve.unseen_m.back() = 0.01F;
  auto network = moves_ends(says(0, kTipUnsupported, std::asinh(-0.5F / kTipUnit)));
  const field::FieldView seen;
  const auto moved = refined(curve, rope.frame(), network, {&seen});
  ASSERT_TRUE(moved);
  EXPECT_EQ(moved->beyond_m[0], 0);
  EXPECT_NEAR(moved->beyond_m[1], -StraightRope::kRadius_m, 1e-6F);
}

TEST(Refined, WhatAKnownLengthLacksIsAtTheEndsThatShowNoTip) {
  const StraightRope rope;
  const auto length_m = static_cast<double>(geometry::length(rope.curve().nodes));
  auto network = moves_ends(says(0));
  const field::FieldView seen;  // no tip at either end
  const auto longer = refined(rope.curve(), rope.frame(), network, {&seen, 1.2 * length_m});
  ASSERT_TRUE(longer);
  for (const float m : longer->beyond_m) {  // a hundredth is tolerance
    EXPECT_NEAR(static_cast<double>(m), 0.094 * length_m, 1e-3 * length_m);
  }
  EXPECT_NEAR(static_cast<double>(geometry::length(longer->nodes)), 1.188 * length_m,
              1e-3 * length_m);
}

TEST(Refined, AKnownLengthThatIsNearlyMetOrFarOffChangesNothing) {
  const StraightRope rope;
  const auto length_m = static_cast<double>(geometry::length(rope.curve().nodes));
  auto network = moves_ends(says(0));
  const field::FieldView seen;
  for (const double times : {0.5, 1.005, 3.0}) {
    const auto same = refined(rope.curve(), rope.frame(), network, {&seen, times * length_m});
    ASSERT_TRUE(same);
    EXPECT_EQ(same->beyond_m[0], 0) << times;
    EXPECT_EQ(same->beyond_m[1], 0) << times;
  }
}

}  // namespace
}  // namespace flowdlo::refine
