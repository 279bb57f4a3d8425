#include "gate_fit/policy.hpp"

#include <gtest/gtest.h>

namespace flowdlo::lab {
namespace {

double score(const std::vector<double>& weights, const std::vector<double>& row) {
  double sum = 0;
  for (std::size_t i = 0; i < row.size(); ++i) sum += weights[i] * row[i];
  return sum;
}

TEST(FitPolicy, PrefersWhatCostsLess) {
  const std::vector<Group> groups(20, {{{1, 0}, {0, 1}}, {0, 5}});
  const auto weights = fit_policy(groups, {0, 0}, 0.01);
  EXPECT_GT(score(weights, {1, 0}), score(weights, {0, 1}));
}

TEST(FitPolicy, AFewDearMistakesOutweighManyCheapOnes) {
  std::vector<Group> groups(10, {{{1, 0}, {0, 1}}, {1, 0}});
  groups.resize(12, {{{1, 0}, {0, 1}}, {0, 10}});
  const auto weights = fit_policy(groups, {0, 0}, 0.01);
  EXPECT_GT(score(weights, {1, 0}), score(weights, {0, 1}));
}

TEST(FitPolicy, WithNothingToLearnTheRidgePullsToNothing) {
  const std::vector<Group> groups(5, {{{1, 0}, {0, 1}}, {2, 2}});
  for (const double weight : fit_policy(groups, {3, -3}, 1)) EXPECT_NEAR(weight, 0, 0.05);
}

}  // namespace
}  // namespace flowdlo::lab
