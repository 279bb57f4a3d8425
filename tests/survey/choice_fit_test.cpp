#include "survey/choice_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace flowdlo::survey {
namespace {

/// Of each ten choices `right` take the first of two options, whose features are (1, x) and zeros.
std::vector<Choice> choices(double x, int right) {
  std::vector<Choice> all;
  for (int i = 0; i < 10; ++i) {
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2, 2);
    rows.row(0) << 1, x;
    all.push_back({rows, i < right ? 0 : 1});
  }
  return all;
}

TEST(ChoiceFit, SaysTheSharesThatWereThere) {
  auto all = choices(0, 2);
  const auto more = choices(1, 9);
  all.insert(all.end(), more.begin(), more.end());
  const Eigen::VectorXd weights = fit(all, 2, 1e-9);
  EXPECT_NEAR(1 / (1 + std::exp(-weights[0])), 0.2, 1e-3);
  EXPECT_NEAR(1 / (1 + std::exp(-weights[0] - weights[1])), 0.9, 1e-3);
  EXPECT_NEAR(quality_of(all, weights).right, 0.85, 1e-9);
}

TEST(ChoiceFit, FixedWeightsStayZero) {
  auto all = choices(0, 2);
  const auto more = choices(1, 9);
  all.insert(all.end(), more.begin(), more.end());
  const Eigen::VectorXd weights = fit(all, 2, 1e-9, {false, true});
  EXPECT_EQ(weights[1], 0);
  EXPECT_NEAR(1 / (1 + std::exp(-weights[0])), 0.55, 1e-3);
}

TEST(ChoiceFit, ARidgeKeepsWeightsFinite) {
  const Eigen::VectorXd weights = fit(choices(1, 10), 2, 0.1);
  EXPECT_LT(weights.norm(), 10);
  EXPECT_GT(weights[1], 0.5);
}

}  // namespace
}  // namespace flowdlo::survey
