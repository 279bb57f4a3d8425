#include "estimator/confidence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "estimator/hypotheses.hpp"

namespace flowdlo {
namespace {

using estimator::confidence;
using gate::Candidate;

/// A rope without crossings that explains mask and depth.
Candidate clear_case() {
  Candidate prior;
  prior.tube = {.mask_recall = 1,
                .mask_precision = 1,
                .hidden_share = 0,
                .depth_agreement = 1,
                .depth_bias = 0,
                .crossing_agreement = 1,
                .overlap_share = 0,
                .crossings = 0,
                .least_sine = 1,
                .least_clearance = 1,
                .bending = 0.5F,
                .sharpest_bend = 0.1F};
  prior.supported = 1;
  return prior;
}

constexpr double kAlone = estimator::kReach;

TEST(Confidence, IsHighWhenNothingSpeaksAgainstTheTraversal) {
  EXPECT_GT(confidence(clear_case(), kAlone), 0.9F);
}

TEST(Confidence, IsLowWhereATubeLeavesALoopOfTheMaskUnexplained) {
  Candidate prior = clear_case();
  prior.tube.mask_recall = 0.8F;
  EXPECT_LT(confidence(prior, kAlone), 0.5F);
}

TEST(Confidence, FallsWithEachThingThatSpeaksAgainstTheTraversal) {
  Candidate start = clear_case();
  start.tube.mask_recall = 0.97F;  // where the curve is steep
  start.tube.mask_precision = 0.97F;
  const float before = confidence(start, 3);
  std::vector<Candidate> worse(10, start);
  worse[0].tube.mask_recall = 0.9F;
  worse[1].tube.mask_precision = 0.9F;
  worse[2].tube.depth_agreement = 0.9F;
  worse[3].tube.crossing_agreement = 0.9F;
  worse[4].supported = 0.7F;
  worse[5].tube.overlap_share = 0.3F;
  worse[6].tube.sharpest_bend = 0.6F;
  worse[7].longest_gap = 8;
  worse[8].hidden_ends = 1;
  worse[9].buried_ends = 1;
  for (std::size_t i = 0; i < worse.size(); ++i) EXPECT_LT(confidence(worse[i], 3), before) << i;
  EXPECT_LT(confidence(start, 0), before);
}

TEST(Confidence, FallsWhereDepthsDisagree) {
  Candidate prior = clear_case();
  prior.tube.depth_agreement = 0.8F;
  prior.tube.crossing_agreement = 0.5F;
  EXPECT_LT(confidence(prior, kAlone), confidence(clear_case(), kAlone));
}

TEST(Confidence, OfAClosedRingIsLowHoweverWellItFits) {
  Candidate prior = clear_case();
  prior.ring = 1;
  EXPECT_LT(confidence(prior, kAlone), 0.3F);
}

TEST(Confidence, OfATraversalThatCouldNotBeDrawnIsNearZero) {
  EXPECT_LT(confidence(Candidate{}, 1), 0.05F);
}

TEST(Confidence, IsZeroForWhatIsNotANumber) {
  Candidate prior = clear_case();
  prior.tube.bending = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(confidence(prior, kAlone), 0);
  EXPECT_EQ(confidence(clear_case(), std::nan("")), 0);
}

TEST(NodeSigma, OfAPriorIsThePriorsOwn) {
  prior::Prior prior;
  prior.sigma_m.fill(0.003F);
  EXPECT_EQ(estimator::node_sigma(Source::kPrior, -1, {}, prior), prior.sigma_m);
}

TEST(NodeSigma, OfAPredictionIsTheModelsFourthHead) {
  flow::Prediction prediction;
  prediction.draws.resize(2);
  prediction.sigma_m.resize(2);
  prediction.sigma_m[1].fill(0.007F);
  EXPECT_EQ(estimator::node_sigma(Source::kPrediction, 1, prediction, {}), prediction.sigma_m[1]);
}

TEST(NodeSigma, WithoutThatHeadIsTheSpreadOfTheDraws) {
  // Two draws 2 cm apart along x: sample deviation sqrt(2) cm.
  flow::Prediction prediction;
  prediction.draws.resize(2);
  for (auto& node : prediction.draws[1]) node.x = 0.02F;
  const auto sigma = estimator::node_sigma(Source::kPrediction, 0, prediction, {});
  EXPECT_NEAR(sigma[10], 0.0141421F, 1e-6);
}

TEST(NodeSigma, IsNeverBelowThatOfASupportedPriorNode) {
  flow::Prediction prediction;
  prediction.draws.resize(4);  // identical draws: no spread
  prior::Prior prior;
  prior.support.fill(1);
  prior.sigma_m.fill(0.002F);
  EXPECT_FLOAT_EQ(estimator::node_sigma(Source::kPrediction, 0, prediction, prior)[5], 0.002F);
}

}  // namespace
}  // namespace flowdlo
