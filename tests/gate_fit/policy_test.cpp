#include "gate_fit/policy.hpp"

#include <gtest/gtest.h>

#include <array>
#include <span>

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

using Net = gate::Network<3, 1>;

TEST(FitPolicyNetwork, LearnsWhatNoStraightScoreCan) {  // the middle one of three is the cheapest
  const std::vector<Group> groups(40, {{{1, -1, 0}, {1, 0, 0}, {1, 1, 0}}, {3, 0, 3}});
  const auto net = network_of<Net>(fit_policy_network(groups, 1e-5, 800, 1));
  EXPECT_GT(net({1, 0, 0})[0], net({1, -1, 0})[0]);
  EXPECT_GT(net({1, 0, 0})[0], net({1, 1, 0})[0]);
}

TEST(FitPolicyNetwork, OnlyDifferencesWithinAGroupCount) {
  std::vector<Group> groups;
  for (int i = 0; i < 40; ++i) {
    const double level = i % 2;  // dear groups are not the fault of what marks them
    groups.push_back({{{1, 0, level}, {1, 1, level}}, {9 * level, 9 * level + 1}});
  }
  const auto net = network_of<Net>(fit_policy_network(groups, 1e-4, 800, 1));
  EXPECT_GT(net({1, 0, 0})[0], net({1, 1, 0})[0]);
  EXPECT_GT(net({1, 0, 1})[0], net({1, 1, 1})[0]);
}

TEST(FitPolicyNetwork, OfSeveralSaysTheMeanOfWhatEachSays) {
  NetworkTask task{.inputs = 3, .outputs = 1, .start = {0}, .ridge = 1e-4, .steps = 40};
  for (int i = 0; i < 20; ++i) {
    const double x = i / 10.0 - 1;
    task.rows.insert(task.rows.end(), {1, x, x * x});
  }
  task.slope = [](std::size_t row, std::span<const double> said, std::span<double> slope) {
    slope[0] = said[0] - (row % 2 == 0 ? 1 : 0);
  };
  const auto both = network_of<gate::Network<3, 1, 16>>(fit_mean_of_networks(task, 2));
  const auto first = network_of<Net>(fit_network(task));
  ++task.seed;
  const auto second = network_of<Net>(fit_network(task));
  for (const double x : {-0.7, 0.2, 0.9}) {
    const std::array<double, 3> row{1, x, x * x};
    EXPECT_NE(first(row)[0], second(row)[0]);
    EXPECT_NEAR(both(row)[0], 0.5 * (first(row)[0] + second(row)[0]), 1e-12);
  }
}

}  // namespace
}  // namespace flowdlo::lab
