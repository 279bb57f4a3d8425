#include "track/cheapest_assignment.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace flowdlo::track {
namespace {

using ::testing::ElementsAre;
using Costs = std::vector<std::vector<double>>;

double total(const Costs& cost, const std::vector<int>& columns) {
  double sum = 0;
  for (std::size_t i = 0; i < cost.size(); ++i)
    sum += cost[i][static_cast<std::size_t>(columns[i])];
  return sum;
}

double least_of_all(const Costs& cost) {
  std::vector<int> order(cost.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  double least = std::numeric_limits<double>::infinity();
  do {
    least = std::min(least, total(cost, order));
  } while (std::next_permutation(order.begin(), order.end()));
  return least;
}

TEST(CheapestAssignment, TakesTheDearerCellWhereTheSumIsLess) {
  EXPECT_THAT(cheapest_assignment({{1, 2}, {1, 9}}), ElementsAre(1, 0));
}

TEST(CheapestAssignment, IsAsCheapAsEveryPermutation) {
  std::mt19937 engine(7);
  for (int round = 0; round < 50; ++round) {
    Costs cost(6, std::vector<double>(6));
    for (auto& row : cost) {
      for (double& value : row) value = static_cast<double>(engine() % 100);
    }
    EXPECT_EQ(total(cost, cheapest_assignment(cost)), least_of_all(cost)) << round;
  }
}

TEST(CheapestAssignment, NothingToAssignIsNothing) { EXPECT_TRUE(cheapest_assignment({}).empty()); }

}  // namespace
}  // namespace flowdlo::track
