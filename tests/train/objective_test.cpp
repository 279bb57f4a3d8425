// Each loss against values worked out by hand.
#include "train/objective.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace flowdlo::train {
namespace {

using torch::Tensor;

/// [1, n, 3] from x, y, z triples.
Tensor curve(const std::vector<double>& values) {
  return torch::tensor(values, torch::kFloat64).view({1, -1, 3});
}

double value(const Tensor& scalar) { return scalar.item<double>(); }

TEST(Objective, VelocityLossIsTheMeanSquareOverCoordinates) {  // Eq. (3.17)
  const auto truth = curve({1, 0, 0, 0, 0, 0});
  const auto source = curve({0, 0, 0, 0, 0, 0});
  const auto velocity = curve({3, 0, 0, 0, 1, 0});  // off by 2 and by 1
  EXPECT_DOUBLE_EQ(value(velocity_loss(velocity, truth, source)), (4.0 + 1.0) / 6);
}

TEST(Objective, SpacingLossIsTheMeanRelativeDeviation) {  // Eq. (3.19)-(3.21)
  const auto truth = curve({0, 0, 0, 1, 0, 0, 4, 0, 0});  // mean segment 2
  const auto nodes = curve({0, 0, 0, 1, 0, 0, 1, 3, 0});  // segments 1 and 3
  EXPECT_NEAR(value(spacing_loss(nodes, truth)), (0.5 + 0.5) / 2, 1e-9);
}

TEST(Objective, BendingLossCountsReversalsAlone) {  // Eq. (3.22)-(3.24)
  const auto straight = curve({0, 0, 0, 1, 0, 0, 2, 0, 0});
  const auto right_angle = curve({0, 0, 0, 1, 0, 0, 1, 1, 0});
  const auto reversal = curve({0, 0, 0, 1, 0, 0, 0, 0, 0});
  const auto sharp = curve({0, 0, 0, 1, 0, 0, 1 - std::sqrt(0.5), std::sqrt(0.5), 0});
  EXPECT_NEAR(value(bending_loss(straight)), 0, 1e-12);
  EXPECT_NEAR(value(bending_loss(right_angle)), 0, 1e-12);
  EXPECT_NEAR(value(bending_loss(reversal)), 1, 1e-9);
  EXPECT_NEAR(value(bending_loss(sharp)), 0.5, 1e-9);
}

TEST(Objective, DirectLossIsSmoothL1WithTwoCentimetres) {  // Sec. 3.5
  const auto truth = curve({0, 0, 0});
  const auto nodes = curve({0.01, 0.05, 0});  // one inside beta, one beyond
  const double inside = 0.5 * 0.01 * 0.01 / 0.02;
  const double beyond = 0.05 - 0.5 * 0.02;
  EXPECT_NEAR(value(direct_loss(nodes, truth)), (inside + beyond) / 3, 1e-12);
}

TEST(Objective, HuberLossIsSquareNearAndLinearFar) {
  const auto truth = curve({0, 0, 0, 0, 0, 0});
  const auto nodes = curve({0.003, 0.004, 0, 10, 0, 0});
  const double near = 0.1 * (std::sqrt(1 + 0.0025) - 1);  // |e| = 0.005
  const double far = 0.1 * (std::sqrt(1 + 10000.0) - 1);
  EXPECT_NEAR(value(huber_loss(nodes, truth, 0.1)), (near + far) / 2, 1e-12);
}

TEST(Objective, HarmLossCountsNodesThatAreFartherThanTheirPrior) {
  const auto truth = curve({0, 0, 0, 0, 0, 0});
  const auto prior = curve({1, 0, 0, 1, 0, 0});
  const auto nodes = curve({3, 0, 0, 0.2, 0, 0});  // worse by 2; better
  EXPECT_NEAR(value(harm_loss(nodes, prior, truth)), 1.0, 1e-9);
}

TEST(Objective, RecordsWithAPriorFarOffWeighLess) {
  const auto truth = curve({0, 0, 0});
  const auto prior = curve({0.03, 0, 0});  // three times the floor of 0.01
  EXPECT_NEAR(value(record_weight(prior, truth, 0.5)), 0.5, 1e-9);
  EXPECT_NEAR(value(record_weight(prior, truth, 0)), 1, 1e-9);
}

TEST(Objective, SigmaLossIsStudentTAndPassesNoGradientToTheNodes) {
  const auto truth = curve({0, 0, 0});
  auto nodes = curve({2, 0, 0}).requires_grad_(true);
  auto log_sigma = torch::full({1, 1}, std::log(0.5), torch::kFloat64).requires_grad_(true);
  const auto loss = sigma_loss(log_sigma, nodes, truth);
  EXPECT_NEAR(value(loss), 3 * std::log(0.5) + 3.5 * std::log(1 + 16.0 / 4), 1e-9);
  loss.backward();
  EXPECT_FALSE(nodes.grad().defined());
  EXPECT_NE(value(log_sigma.grad().sum()), 0);
}

TEST(Objective, SigmaIsBestWhereItFitsTheErrors) {
  torch::manual_seed(4);
  const auto truth = torch::zeros({1, 4000, 3}, torch::kFloat64);
  const auto nodes = 0.3 * torch::randn({1, 4000, 3}, torch::kFloat64);
  const auto loss = [&](double sigma) {
    return value(
        sigma_loss(torch::full({1, 4000}, std::log(sigma), torch::kFloat64), nodes, truth));
  };
  EXPECT_LT(loss(0.27), loss(0.15));
  EXPECT_LT(loss(0.27), loss(0.6));
}

Target small_target() {
  torch::manual_seed(3);
  const auto random = [] { return torch::randn({2, 5, 3}, torch::kFloat64); };
  Target target{
      {},       torch::tensor({0.25, 0.5}, torch::kFloat64),
      random(), random(),
      random(), torch::tensor({{0.1, 0.2, 0.5, 0.3}, {0.0, 0.1, 0.6, 0.2}}, torch::kFloat64)};
  const auto t = target.time.view({-1, 1, 1});
  target.state = (1 - t) * target.source + t * target.truth;
  return target;
}

TEST(Objective, TrueVelocityHasNoVelocityLossAndTheCleanStateOfTheTruth) {  // Eq. (3.18)
  const Target target = small_target();
  const auto output = target.truth - target.source;
  const Losses losses = objective({}, {}, output, target);
  EXPECT_NEAR(value(losses.primary), 0, 1e-12);
  EXPECT_TRUE(torch::allclose(clean_state({}, output, target), target.truth));
}

TEST(Objective, TotalIsTheWeightedSum) {  // Eq. (3.25)
  const Target target = small_target();
  const auto output = torch::randn({2, 5, 3}, torch::kFloat64);
  const ObjectiveConfig config;
  const Losses losses = objective({}, config, output, target);
  EXPECT_NEAR(value(losses.total),
              value(losses.primary) + 0.02 * value(losses.spacing) + 0.01 * value(losses.bending),
              1e-12);
}

TEST(Objective, DirectModelsCleanStateIsItsOutput) {
  weights::Variant variant;
  variant.parameterization = ops::Parameterization::kDirect;
  const Target target = small_target();
  EXPECT_TRUE(torch::equal(clean_state(variant, target.truth, target), target.truth));
  EXPECT_NEAR(value(objective(variant, {}, target.truth, target).primary), 0, 1e-12);
}

}  // namespace
}  // namespace flowdlo::train
