#include "refine/refined.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reference/program.hpp"
#include "support/straight_rope.hpp"

namespace flowdlo::refine {
namespace {

using testing::StraightRope;

/// A network that says the same of every node.
Network says(float deep, float aside) {
  auto weights = weights::seeded_refine(1);
  for (auto& tensor : weights.tensors) std::fill(tensor.values.begin(), tensor.values.end(), 0.0F);
  auto& bias = weights.tensors.back();
  bias.values[0] = deep;
  bias.values[1] = aside;
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
