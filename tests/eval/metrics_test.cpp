#include "eval/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace flowdlo::eval {
namespace {

// 63 cm along x, a node each centimetre.
Centerline straight(float y = 0) {
  Centerline nodes{};
  for (int i = 0; i < kNodes; ++i) {
    nodes[static_cast<std::size_t>(i)] = {0.01F * static_cast<float>(i), y, 0.5F};
  }
  return nodes;
}

TEST(Metrics, ShiftedRopeIsOffByTheShift) {
  EXPECT_NEAR(index_error_m(straight(0.03F), straight()), 0.03, 1e-7);
  EXPECT_NEAR(frechet_m(straight(0.03F), straight()), 0.03, 1e-7);
}

TEST(Metrics, IndexErrorIsTheMeanOverNodes) {
  Centerline nodes = straight();
  nodes[10].y = 0.64F;
  EXPECT_NEAR(index_error_m(nodes, straight()), 0.01, 1e-7);  // 0.64 / 64
  EXPECT_NEAR(frechet_m(nodes, straight()), 0.64, 1e-7);      // but the farthest node counts here
}

TEST(Metrics, FrechetForgivesASlipAlongTheRopeThatTheIndexErrorCounts) {
  Centerline slipped = straight();  // the first half stretched, the second squeezed: 5 cm at most
  for (int i = 0; i < kNodes; ++i) {
    const float t = static_cast<float>(i) / (kNodes - 1);
    slipped[static_cast<std::size_t>(i)].x += 0.05F * std::sin(3.14159265F * t);
  }
  EXPECT_GT(index_error_m(slipped, straight()), 0.03);
  EXPECT_LT(frechet_m(slipped, straight()), 0.011);
}

TEST(Metrics, FrechetKeepsTheOrder) {
  EXPECT_NEAR(frechet_m(reversed(straight()), straight()), 0.63, 1e-6);
}

TEST(Metrics, FrechetOfASmallCaseDoneByHand) {
  // All true nodes in the origin but the last, 1 m away; all estimated ones in the origin: the last
  // true node has to be coupled with one that is 1 m off.
  Centerline truth{};
  truth.back().x = 1;
  EXPECT_NEAR(frechet_m(Centerline{}, truth), 1.0, 1e-9);
  EXPECT_NEAR(frechet_m(truth, Centerline{}), 1.0, 1e-9);
}

TEST(Metrics, CanonicalBeginsAtTheSmallerX) {
  EXPECT_EQ(canonical(reversed(straight())), straight());
  EXPECT_EQ(canonical(straight()), straight());
}

TEST(Metrics, CanonicalTakesTheSmallerYWhereXTies) {
  Centerline nodes{};
  nodes.front() = {0.1F, 0.3F, 0.5F};
  nodes.back() = {0.1F, 0.2F, 0.9F};
  EXPECT_EQ(canonical(nodes), reversed(nodes));
}

TEST(Metrics, StrandErrorsAreNoneForASmallSlip) {
  Centerline slipped = straight();
  for (Point3& node : slipped) node.x += 0.05F;  // 5 of 63 cm: less than a tenth
  EXPECT_EQ(strand_errors(slipped, straight()), 0);
}

TEST(Metrics, StrandErrorsCountNodesOnAnotherStrand) {
  Centerline nodes = straight();
  for (std::size_t i = 0; i < 16; ++i) nodes[i].x = 0.01F * static_cast<float>(i + 30);
  EXPECT_NEAR(strand_errors(nodes, straight()), 16.0 / 64, 1e-9);
}

TEST(Metrics, ScoreSeesAFlipAndStillComparesAsPublished) {
  const Score flipped = score(reversed(straight()), straight());
  EXPECT_TRUE(flipped.flipped);
  EXPECT_GT(flipped.index_m, 0.3);
  EXPECT_NEAR(flipped.either_index_m, 0, 1e-9);
  EXPECT_EQ(flipped.strand_errors, 0);
}

TEST(Metrics, ScoreDoesNotCareWhichWayTheTruthWasStored) {
  const Score one = score(straight(0.01F), straight());
  const Score other = score(straight(0.01F), reversed(straight()));
  EXPECT_FALSE(one.flipped);
  EXPECT_FALSE(other.flipped);
  EXPECT_EQ(one.index_m, other.index_m);
  EXPECT_EQ(one.frechet_m, other.frechet_m);
}

}  // namespace
}  // namespace flowdlo::eval
