// What sigma_m is made from, on ropes of 32 cm along x.
#include "gate/node_features.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace flowdlo::gate {
namespace {

// Where the features that these tests look at stand in a row.
constexpr std::size_t kSpread = 2;
constexpr std::size_t kVoted = 7;
constexpr std::size_t kNearerTip = 8;
constexpr std::size_t kFartherTip = 9;
constexpr std::size_t kSlant = 10;
constexpr std::size_t kAlone = 13;

Candidate straight(int hypothesis) {
  Candidate candidate;
  for (std::size_t i = 0; i < kNodes; ++i) {
    candidate.nodes[i] = {0.005F * static_cast<float>(i), 0, 0.5F};
  }
  candidate.sigma_m.fill(0.001F);
  candidate.hypothesis = hypothesis;
  candidate.radius_m = 0.003F;
  return candidate;
}

/// Leaves the first rope behind its middle.
Candidate branching(int hypothesis) {
  Candidate candidate = straight(hypothesis);
  for (std::size_t i = kNodes / 2; i < kNodes; ++i) candidate.nodes[i].y = 0.1F;
  return candidate;
}

NodeFeatures features_of(const std::vector<Candidate>& candidates, double rival_score) {
  if (candidates.size() == 1) {
    return {candidates, std::vector<std::size_t>{0}, std::vector<double>{0}, 0, 0.9};
  }
  return {candidates, std::vector<std::size_t>{0, 1}, std::vector<double>{0, rival_score}, 0, 0.9};
}

TEST(NodeFeatures, ARivalCastsDoubtWhereItRunsElsewhere) {
  const std::vector candidates{straight(0), branching(1)};
  const NodeFeatures features = features_of(candidates, 0);
  EXPECT_GT(features.of(50)[kSpread], features.of(10)[kSpread] + 3);
}

TEST(NodeFeatures, ARivalOfLowScoreCastsLess) {
  const std::vector candidates{straight(0), branching(1)};
  const double near = features_of(candidates, -1).of(50)[kSpread];
  const double far = features_of(candidates, -5).of(50)[kSpread];
  EXPECT_LT(far, near - 1);
}

TEST(NodeFeatures, ARivalThatMoreReadingsHoldCastsMore) {
  std::vector candidates{straight(0), branching(1)};
  candidates[1].odds = 0.4F;
  const double many = features_of(candidates, 0).of(50)[kVoted];
  candidates[1].odds = 0.1F;
  const double few = features_of(candidates, 0).of(50)[kVoted];
  EXPECT_GT(many, few + 0.5);
}

TEST(NodeFeatures, ARivalWalkedTheOtherWayRunsNowhereElse) {
  Candidate back = straight(1);
  std::reverse(back.nodes.begin(), back.nodes.end());
  const std::vector candidates{straight(0), back};
  const NodeFeatures features = features_of(candidates, 0);
  EXPECT_NEAR(features.of(0)[kSpread], features.of(32)[kSpread], 1e-9);
}

TEST(NodeFeatures, SayThatThereIsNoRival) {
  const std::vector alone{straight(0)};
  const std::vector two{straight(0), branching(1)};
  EXPECT_EQ(features_of(alone, 0).of(0)[kAlone], 1);
  EXPECT_EQ(features_of(two, 0).of(0)[kAlone], 0);
}

TEST(NodeFeatures, KnowHowFarBothTipsMayBeOff) {
  std::vector candidates{straight(0)};
  candidates[0].sigma_m.back() = 0.01F;
  const NodeFeatures features = features_of(candidates, 0);
  EXPECT_NEAR(features.of(50)[kNearerTip] - features.of(50)[kFartherTip], std::log(10), 1e-3);
  EXPECT_EQ(features.of(10)[kNearerTip], features.of(50)[kFartherTip]);
  EXPECT_EQ(features.of(10)[kFartherTip], features.of(50)[kNearerTip]);
}

TEST(NodeFeatures, KnowWhereTheRopeRunsTowardsTheCamera) {
  std::vector candidates{straight(0)};
  for (std::size_t i = 40; i < kNodes; ++i) {  // along the ray
    candidates[0].nodes[i] = {0.4F * (0.5F + 0.005F * static_cast<float>(i - 39)), 0,
                              0.5F + 0.005F * static_cast<float>(i - 39)};
  }
  const NodeFeatures features = features_of(candidates, 0);
  EXPECT_LT(features.of(5)[kSlant], 0.2);
  EXPECT_GT(features.of(50)[kSlant], 2);
}

TEST(NodeFeatures, AreFiniteWhereACandidateIsNot) {
  Candidate lost = branching(1);
  lost.nodes[3].x = std::numeric_limits<float>::infinity();
  std::vector candidates{straight(0), lost};
  const NodeFeatures features = features_of(candidates, 0);
  for (std::size_t node = 0; node < kNodes; ++node) {
    for (const double value : features.of(node)) EXPECT_TRUE(std::isfinite(value));
  }
  candidates[0].nodes[7].z = std::numeric_limits<float>::quiet_NaN();
  for (const double value : features_of(candidates, 0).of(7)) EXPECT_TRUE(std::isfinite(value));
}

}  // namespace
}  // namespace flowdlo::gate
