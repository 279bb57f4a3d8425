#include "refine/refined.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "reference/program.hpp"
#include "support/straight_rope.hpp"

namespace flowdlo::refine {
namespace {

using testing::StraightRope;

/// A network that says the same of every node; of `laid` the log odds.
Network says(float deep, float aside, float laid = -50) {
  auto weights = weights::seeded_refine(1);
  for (auto& tensor : weights.tensors) std::fill(tensor.values.begin(), tensor.values.end(), 0.0F);
  auto& bias = weights.tensors.back();
  bias.values[0] = deep;
  bias.values[1] = aside;
  bias.values[2] = laid;
  auto network = Network::create(weights, [] { return reference::create_program(1); });
  if (!network) throw std::runtime_error(network.error().message);
  return *std::move(network);
}

TEST(Refined, MovesNodesAwayFromTheCameraAndAsideInRadii) {
  const StraightRope rope;
  const auto before = rope.curve().nodes;
  auto network = says(0.5F, -1);
  const auto nodes = refined(rope.curve(), rope.frame(), network);
  ASSERT_TRUE(nodes);
  for (std::size_t i = 0; i < kNodes; ++i) {
    EXPECT_GT(nodes->nodes[i].z, before[i].z + 0.4F * StraightRope::kRadius_m);
    // A rope from left to right in front of the camera: aside of it is down in the image.
    EXPECT_NEAR(nodes->nodes[i].y - before[i].y, -StraightRope::kRadius_m,
                0.02F * StraightRope::kRadius_m);
    const float off = std::hypot(nodes->nodes[i].x - before[i].x, nodes->nodes[i].y - before[i].y,
                                 nodes->nodes[i].z - before[i].z);
    EXPECT_NEAR(off, std::hypot(0.5F, 1.0F) * StraightRope::kRadius_m, 1e-6F);
  }
}

TEST(Refined, NoFartherThanAllowed) {
  const StraightRope rope;
  auto network = says(1000, 0);
  const auto nodes = refined(rope.curve(), rope.frame(), network);
  ASSERT_TRUE(nodes);
  const auto before = rope.curve().nodes;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const float off = std::hypot(nodes->nodes[i].x - before[i].x, nodes->nodes[i].y - before[i].y,
                                 nodes->nodes[i].z - before[i].z);
    EXPECT_NEAR(off, kMostOffset * StraightRope::kRadius_m, 1e-6F);
  }
}

/// Depths beside the rope that are 4 mm off either way, in stretches of 8 px.
StraightRope on_a_noisy_table() {
  constexpr std::array<float, 5> kOff_m{0, 7e-3F, -3.6e-3F, 3.6e-3F, -7e-3F};
  StraightRope rope;
  const auto mask = rope.frame().mask;
  for (std::size_t i = 0; i < rope.depth_m().size(); ++i) {
    if (mask[i] == 0) rope.depth_m()[i] += kOff_m[i % StraightRope::kWidth / 8 % kOff_m.size()];
  }
  return rope;
}

/// The rope, as if it were read by that many radii too deep.
Curve too_deep(const StraightRope& rope, float radii) {
  Curve curve = rope.curve();
  for (Point3& node : curve.nodes) {
    const float share = 1 + radii * StraightRope::kRadius_m / node.z;
    node = {share * node.x, share * node.y, share * node.z};
  }
  return curve;
}

TEST(Refined, LaysNodesOnTheTableWithinWhatDepthsAreOffBy) {
  const StraightRope rope = on_a_noisy_table();
  for (const float radii : {-2.5F, 2.5F}) {
    auto network = says(0, 0, 50);
    const auto nodes = refined(too_deep(rope, radii), rope.frame(), network);
    ASSERT_TRUE(nodes);
    for (const Point3& node : nodes->nodes) {
      EXPECT_NEAR(node.z, StraightRope::kAxis_m, 0.15F * StraightRope::kRadius_m);
    }
  }
}

TEST(Refined, WhatLiesFartherFromTheTableThanDepthsAreOffStays) {
  const StraightRope rope;  // depths without noise
  const Curve curve = too_deep(rope, -6);
  auto network = says(0, 0, 50);
  const auto nodes = refined(curve, rope.frame(), network);
  ASSERT_TRUE(nodes);
  for (std::size_t i = 0; i < kNodes; ++i) EXPECT_EQ(nodes->nodes[i].z, curve.nodes[i].z);
}

TEST(Refined, AsMuchOfTheWayToTheTableAsTheNetworkSays) {
  const StraightRope rope = on_a_noisy_table();
  const Curve curve = too_deep(rope, 2);
  auto network = says(0, 0, std::log(1.0F / 3));  // a quarter
  const auto nodes = refined(curve, rope.frame(), network);
  ASSERT_TRUE(nodes);
  for (const Point3& node : nodes->nodes) {
    EXPECT_NEAR(node.z, StraightRope::kAxis_m + 1.5F * StraightRope::kRadius_m,
                0.15F * StraightRope::kRadius_m);
  }
}

TEST(Refined, WithoutATableNodesStay) {
  StraightRope rope = on_a_noisy_table();
  const auto mask = rope.frame().mask;
  for (std::size_t i = 0; i < rope.depth_m().size(); ++i) {
    if (mask[i] == 0) rope.depth_m()[i] = 0;
  }
  const Curve curve = too_deep(rope, 4);
  auto network = says(0, 0, 50);
  const auto nodes = refined(curve, rope.frame(), network);
  ASSERT_TRUE(nodes);
  for (std::size_t i = 0; i < kNodes; ++i) EXPECT_EQ(nodes->nodes[i].z, curve.nodes[i].z);
}

TEST(Refined, ACurveWithoutAStripStaysAsItIs) {
  const StraightRope rope;
  auto curve = rope.curve();
  curve.radius_m = 0;
  auto network = says(1, 1);
  const auto nodes = refined(curve, rope.frame(), network);
  ASSERT_TRUE(nodes);
  for (std::size_t i = 0; i < kNodes; ++i) EXPECT_EQ(nodes->nodes[i].z, curve.nodes[i].z);
}

TEST(Refined, NodesOnOnePointStayThere) {
  const StraightRope rope;
  auto curve = rope.curve();
  curve.nodes.fill(curve.nodes[20]);
  auto network = says(1, 1);
  const auto nodes = refined(curve, rope.frame(), network);
  ASSERT_TRUE(nodes);
  for (const Point3& node : nodes->nodes) EXPECT_EQ(node.z, curve.nodes[20].z);
}

}  // namespace
}  // namespace flowdlo::refine
