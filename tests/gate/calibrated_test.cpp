// The calibrated gate, on candidates made by hand: straight ropes of 32 cm along x.
#include "gate/calibrated.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <vector>

#include "gate/fitted.hpp"
#include "weights/field_weights.hpp"
#include "weights/weights.hpp"

namespace flowdlo::gate {
namespace {

// Where the features that these tests weigh stand in their lists.
constexpr std::size_t kMoved = 2;             // of draw_features: against the prior's sigma
constexpr std::size_t kRecallGained = 10;     // of draw_features
constexpr std::size_t kRecallMissed = 21;     // of hypothesis_features: of 0.3
constexpr std::size_t kVotes = 5;             // of hypothesis_features
constexpr std::size_t kClosenessRecall = 10;  // of closeness_features: of 0.3
constexpr std::size_t kClosenessLead = 1;

Candidate straight(float shift_m, int hypothesis = 0, int draw = -1) {
  Candidate candidate;
  for (std::size_t i = 0; i < kNodes; ++i) {
    candidate.nodes[i] = {0.005F * static_cast<float>(i), shift_m, 0.5F};
  }
  candidate.sigma_m.fill(0.001F);
  candidate.draw = draw;
  candidate.hypothesis = hypothesis;
  candidate.radius_m = 0.003F;
  candidate.pixel_m = 0.001F;
  candidate.noise_m = 0.001F;
  candidate.supported = 1;
  candidate.tube = {.mask_recall = 1,
                    .mask_precision = 1,
                    .depth_agreement = 1,
                    .crossing_agreement = 1,
                    .overlap_share = 0,
                    .least_sine = 1,
                    .least_clearance = 1,
                    .bending = 0.1F,
                    .sharpest_bend = 0.01F};
  return candidate;
}

Candidate with_recall(Candidate candidate, float recall) {
  candidate.tube.mask_recall = recall;
  return candidate;
}

/// Prefers what explains more of the mask.
GateWeights by_recall() {
  GateWeights weights;
  weights.draw[kRecallGained] = 1;
  weights.hypothesis.straight[0][kRecallMissed] = -1;
  return weights;
}

/// Of the shipped weights: to frames whose mask alone is read, and to those that the field saw.
GateWeights shipped_for_mask() {
  return gate_weights(*weights::load(FLOWDLO_DEFAULT_WEIGHTS)->calibration);
}
GateWeights shipped_for_field() {
  const auto field =
      std::filesystem::path(FLOWDLO_DEFAULT_WEIGHTS).parent_path() / "field.safetensors";
  return gate_weights(*weights::load_field(field)->calibration);
}

TEST(CalibratedGate, APriorAloneIsReturned) {
  const std::vector candidates{straight(0)};
  EXPECT_EQ(choose_calibrated(candidates, by_recall()).chosen, 0U);
}

TEST(CalibratedGate, ADrawThatExplainsMoreReplacesItsPrior) {
  const std::vector candidates{with_recall(straight(0), 0.8F), straight(0.01F, 0, 0)};
  EXPECT_EQ(choose_calibrated(candidates, by_recall()).chosen, 1U);
}

TEST(CalibratedGate, ADrawThatLeadsByLessThanTheMarginDoesNot) {
  const std::vector candidates{with_recall(straight(0), 0.95F), straight(0.01F, 0, 0)};
  GateWeights weights = by_recall();
  weights.draw_margin = 0.24;
  EXPECT_EQ(choose_calibrated(candidates, weights).chosen, 1U);
  weights.draw_margin = 0.26;
  EXPECT_EQ(choose_calibrated(candidates, weights).chosen, 0U);
}

TEST(CalibratedGate, OfTwoDrawsTheBetterOneAndOfEqualOnesTheFirstIsTaken) {
  const Candidate prior = with_recall(straight(0), 0.5F);
  const Candidate fair = with_recall(straight(0.01F, 0, 0), 0.6F);
  const Candidate good = with_recall(straight(0.01F, 0, 1), 0.7F);
  EXPECT_EQ(choose_calibrated(std::vector{prior, fair, good}, by_recall()).chosen, 2U);
  EXPECT_EQ(choose_calibrated(std::vector{prior, good, good}, by_recall()).chosen, 1U);
}

TEST(CalibratedGate, ARunnerUpThatExplainsMoreWins) {
  const std::vector candidates{with_recall(straight(0), 0.7F), straight(0.1F, 1)};
  EXPECT_EQ(choose_calibrated(candidates, by_recall()).chosen, 1U);
}

TEST(CalibratedGate, ARunnerUpThatLeadsByLessThanTheMarginDoesNot) {
  const std::vector candidates{with_recall(straight(0), 0.85F), straight(0.1F, 1)};
  GateWeights weights = by_recall();
  weights.hypothesis_margin = 0.6;
  EXPECT_EQ(choose_calibrated(candidates, weights).chosen, 0U);
}

TEST(CalibratedGate, ARunnersUpDrawIsHeldAgainstItsOwnPrior) {
  const std::vector candidates{with_recall(straight(0), 0.7F), with_recall(straight(0.1F, 1), 0.8F),
                               with_recall(straight(0.1F, 1, 3), 0.9F)};
  EXPECT_EQ(choose_calibrated(candidates, by_recall()).chosen, 2U);
}

TEST(CalibratedGate, TheProbabilityIsTheLogisticOfItsWeights) {
  const std::vector candidates{straight(0)};
  GateWeights weights;
  EXPECT_DOUBLE_EQ(choose_calibrated(candidates, weights).probability, 0.5);
  weights.closeness.straight[0][0] = std::log(3.0);
  EXPECT_NEAR(choose_calibrated(candidates, weights).probability, 0.75, 1e-12);
}

TEST(CalibratedGate, LessOfTheMaskExplainedIsLessLikely) {
  GateWeights weights;
  weights.closeness.straight[0][kClosenessRecall] = -2;
  double before = 1;
  for (const float recall : {1.0F, 0.95F, 0.9F, 0.8F}) {
    const std::vector candidates{with_recall(straight(0), recall)};
    const double now = choose_calibrated(candidates, weights).probability;
    EXPECT_LT(now, before);
    before = now;
  }
}

TEST(CalibratedGate, OnlyCandidatesThatRunElsewhereCastDoubt) {
  GateWeights weights = by_recall();
  weights.closeness.straight[0][kClosenessLead] = 1;
  const Candidate best = straight(0);
  const double alone = choose_calibrated(std::vector{best}, weights).probability;
  const double beside =
      choose_calibrated(std::vector{best, straight(0.002F, 1)}, weights).probability;
  const double against =
      choose_calibrated(std::vector{best, straight(0.1F, 1)}, weights).probability;
  EXPECT_DOUBLE_EQ(beside, alone);
  EXPECT_LT(against, alone);
}

TEST(CalibratedGate, ARopeWalkedTheOtherWayRunsNowhereElse) {
  const Candidate there = straight(0);
  Candidate back = there;
  std::reverse(back.nodes.begin(), back.nodes.end());
  EXPECT_FALSE(runs_elsewhere(there, back));
  EXPECT_TRUE(runs_elsewhere(there, straight(0.1F)));
}

/// Every node about that far off, and none elsewhere.
GateWeights all_off_by(double distance_m) {
  GateWeights weights;
  weights.node_error.straight[0][0] = std::log(distance_m);
  weights.node_error.straight[2][0] = -50;
  weights.node_error.straight[3][0] = -2;
  return weights;
}

TEST(CalibratedGate, TwoSigmaAreWhatThePromisedShareOfNodesIsWithin) {
  const std::vector candidates{straight(0)};
  GateWeights weights = all_off_by(0.004);
  weights.sigma_share = 0.5;
  for (const float sigma_m : choose_calibrated(candidates, weights).sigma_m) {
    EXPECT_NEAR(sigma_m, 0.002F, 1e-6F);
  }
  weights.sigma_share = 0.9;
  for (const float sigma_m : choose_calibrated(candidates, weights).sigma_m) {
    EXPECT_NEAR(sigma_m, 0.002 * std::pow(9.0, std::exp(-2.0)), 1e-6);
  }
}

TEST(CalibratedGate, WhatIsNotFiniteIsNeverPreferred) {
  const float nothing = std::numeric_limits<float>::quiet_NaN();
  GateWeights weights = by_recall();
  weights.draw[kMoved] = 1;
  Candidate lost = straight(0.1F, 1);
  lost.tube.mask_recall = nothing;
  Candidate draw = straight(0.01F, 0, 0);
  draw.tube.mask_recall = nothing;
  const std::vector candidates{with_recall(straight(0), 0.5F), lost, draw};
  EXPECT_EQ(choose_calibrated(candidates, weights).chosen, 0U);
}

TEST(CalibratedGate, AnswersAreFiniteWhateverTheCandidate) {
  const float nothing = std::numeric_limits<float>::quiet_NaN();
  Candidate lost = straight(0);
  lost.nodes[3].x = std::numeric_limits<float>::infinity();
  lost.sigma_m.fill(nothing);
  lost.radius_m = nothing;
  lost.tube.depth_bias = nothing;
  const Choice choice = choose_calibrated(std::vector{lost, lost}, shipped_for_mask());
  EXPECT_EQ(choice.chosen, 0U);
  EXPECT_GE(choice.probability, 0);
  EXPECT_LE(choice.probability, 1);
  for (const float sigma_m : choice.sigma_m) {
    EXPECT_TRUE(std::isfinite(sigma_m));
    EXPECT_GT(sigma_m, 0);
  }
}

TEST(CalibratedGate, WhatMostReadingsAgreeOnCanWin) {
  GateWeights weights;
  weights.hypothesis.straight[0][kVotes] = 1;
  Candidate alone = straight(0);
  alone.votes = 0.2F;
  Candidate agreed = straight(0.1F, 1);
  agreed.votes = 0.8F;
  EXPECT_EQ(choose_calibrated(std::vector{alone, agreed}, weights).chosen, 1U);
}

TEST(FittedGate, TrustsACleanRopeAndDoubtsOneThatLeavesTheMaskUnexplained) {
  const double clean = choose_calibrated(std::vector{straight(0)}, shipped_for_mask()).probability;
  Candidate poor = with_recall(straight(0), 0.6F);
  poor.tube.mask_precision = 0.7F;
  poor.tube.depth_agreement = 0.6F;
  poor.longest_gap = 15;
  poor.buried_ends = 0.5F;
  const double wrong = choose_calibrated(std::vector{poor}, shipped_for_mask()).probability;
  EXPECT_GT(clean, 0.8);
  EXPECT_LT(wrong, 0.5);
}

TEST(FittedGate, DoubtWidensSigma) {
  const Choice clean = choose_calibrated(std::vector{straight(0)}, shipped_for_mask());
  Candidate poor = with_recall(straight(0), 0.6F);
  poor.tube.mask_precision = 0.7F;
  poor.buried_ends = 0.5F;
  const Choice wrong = choose_calibrated(std::vector{poor}, shipped_for_mask());
  for (std::size_t i = 0; i < kNodes; ++i) EXPECT_GT(wrong.sigma_m[i], clean.sigma_m[i]);
}

TEST(FittedGate, KeepsTheCleanPriorAgainstAWorseRunnerUp) {
  Candidate other = with_recall(straight(0.1F, 1), 0.7F);
  other.behind = 5;
  EXPECT_EQ(choose_calibrated(std::vector{straight(0), other}, shipped_for_mask()).chosen, 0U);
}

/// Two of which the first explains a little more: scores 0 and -0.1.
std::vector<Candidate> nearly_level() {
  return {straight(0), with_recall(straight(0.05F, 1), 0.97F)};
}

TEST(CalibratedGate, WhatIsKnownBesideTheFrameDecidesWhereItDoesNot) {
  const Choice choice = choose_calibrated(nearly_level(), by_recall(), {.log_prior = {-1, 0}});
  EXPECT_EQ(choice.chosen, 1U);
  EXPECT_TRUE(choice.switched);
  const Choice confirmed = choose_calibrated(nearly_level(), by_recall(), {.log_prior = {0, -1}});
  EXPECT_EQ(confirmed.chosen, 0U);
  EXPECT_FALSE(confirmed.switched);
}

TEST(CalibratedGate, AScoreThatIsClearOverrulesWhatIsKnownBesideTheFrame) {
  const Choice choice = choose_calibrated(nearly_level(), by_recall(), {.log_prior = {-0.05, 0}});
  EXPECT_EQ(choice.chosen, 0U);
  EXPECT_FALSE(choice.switched);
}

TEST(CalibratedGate, AGuestIsTakenByItsScoreAndWhatSpeaksForIt) {
  const std::vector candidates{with_recall(straight(0), 0.9F)};
  Beside beside{.guest = straight(0.05F, 1)};
  const Choice taken = choose_calibrated(candidates, by_recall(), beside);
  EXPECT_EQ(taken.chosen, 1U);
  EXPECT_TRUE(taken.switched);
  beside.guest_log_prior = -1;
  EXPECT_EQ(choose_calibrated(candidates, by_recall(), beside).chosen, 0U);
}

TEST(CalibratedGate, SigmaGoesByTheProbabilityThatIsKnownInAll) {
  Candidate poor = with_recall(straight(0), 0.6F);
  poor.buried_ends = 0.5F;
  const std::vector candidates{poor};
  const Choice alone = choose_calibrated(candidates, shipped_for_field());
  const auto said = [&](double probability) {
    return choose_calibrated(candidates, shipped_for_field(),
                             {.in_all = [=](double) { return probability; }});
  };
  const Choice sure = said(0.99);
  const Choice doubtful = said(0.05);
  EXPECT_EQ(sure.probability, alone.probability);
  EXPECT_EQ(said(alone.probability).sigma_m, alone.sigma_m);
  for (std::size_t i = 0; i < kNodes; ++i) EXPECT_LT(sure.sigma_m[i], doubtful.sigma_m[i]);
}

TEST(CalibratedGate, WithoutAStrandFieldNothingOfItIsWeighed) {
  constexpr std::size_t kOfField = 14;  // features of a hypothesis
  const std::vector candidates{straight(0), straight(0.05F, 1)};
  const auto row = hypothesis_features(candidates, 1);
  for (std::size_t i = kHypothesisFeatures - kOfField; i < kHypothesisFeatures; ++i) {
    EXPECT_EQ(row[i], 0) << i;
  }
}

TEST(CalibratedGate, AnAxisThatIsNotFollowedCountsAgainstAHypothesis) {
  std::vector candidates{straight(0), straight(0.05F, 1)};
  for (Candidate& candidate : candidates) {
    candidate.axes = {.known = true, .followed = 1, .backed = 1, .tips_met = 1};
    candidate.readings = 4;
    candidate.seen_odds = 0.5F;
  }
  const GateWeights weights = shipped_for_field();
  const auto lead = [&] {
    return hypothesis_score(candidates, 1, weights) - hypothesis_score(candidates, 0, weights);
  };
  const double alike = lead();
  candidates[0].axes.followed = 0.6F;
  EXPECT_GT(lead(), alike);
}

TEST(CalibratedGate, AGuestThatIsNotTakenIsNotCounted) {
  const std::vector candidates{straight(0), with_recall(straight(0.05F, 1), 0.8F)};
  const GateWeights weights = shipped_for_mask();
  const Choice alone = choose_calibrated(candidates, weights);
  const Choice visited = choose_calibrated(candidates, weights,
                                           {.guest = straight(0.0001F, 2), .guest_log_prior = -99});
  EXPECT_EQ(visited.chosen, alone.chosen);
  EXPECT_EQ(visited.probability, alone.probability);
  EXPECT_EQ(visited.sigma_m, alone.sigma_m);
}

}  // namespace
}  // namespace flowdlo::gate
