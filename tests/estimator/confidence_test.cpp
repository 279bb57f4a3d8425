#include "estimator/confidence.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace flowdlo {
namespace {

const std::array<std::uint8_t, 4> kAll{1, 1, 1, 1};
const std::array<std::uint8_t, 4> kHalf{1, 0, 1, 0};

TEST(Confidence, IsOneWhenNothingSpeaksAgainstTheCurve) {
  EXPECT_FLOAT_EQ(estimator::confidence(1.0F, 1.0F, kAll), 1.0F);
}

TEST(Confidence, ATieOfTraversalsHalvesIt) {
  EXPECT_FLOAT_EQ(estimator::confidence(1.0F, 0.0F, kAll), 0.5F);
}

TEST(Confidence, MissingSupportLowersIt) {  // 0.5 + 0.5 * 1/2
  EXPECT_FLOAT_EQ(estimator::confidence(1.0F, 1.0F, kHalf), 0.75F);
}

TEST(Confidence, IsZeroOffTheMaskAndForWhatIsNotANumber) {
  EXPECT_FLOAT_EQ(estimator::confidence(0.0F, 1.0F, kAll), 0.0F);
  EXPECT_FLOAT_EQ(estimator::confidence(std::numeric_limits<float>::quiet_NaN(), 1, kAll), 0.0F);
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
