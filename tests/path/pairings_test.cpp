#include "path/pairings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace flowdlo::path {
namespace {

struct Problem {
  std::vector<float> alone;
  std::vector<Pair> pairs;
};

Problem random_problem(std::mt19937& random, int items, unsigned one_in) {
  Problem problem;
  for (int i = 0; i < items; ++i) {
    problem.alone.push_back(static_cast<float>(random() % 400) / 100);
    for (int j = 0; j < i; ++j) {
      if (random() % one_in == 0) {
        problem.pairs.push_back({j, i, static_cast<float>(random() % 900) / 100});
      }
    }
  }
  return problem;
}

// Whether items 2 * i and 2 * i + 1, which are one thing's, make with the pairs a chain of several
// things that comes back to its beginning; `partner` [items], -1: alone.
bool comes_back(const std::vector<int>& partner) {
  for (int item = 0; item < static_cast<int>(partner.size()); ++item) {
    int at = item;
    for (std::size_t step = 0; step < partner.size(); ++step) {
      const int other = partner[static_cast<std::size_t>(at)];
      if (other < 0 || other == (at ^ 1)) break;
      at = other ^ 1;
      if (at == item) return true;
    }
  }
  return false;
}

// Every pairing, by brute force: ascending costs of those that make no pair dearer than both alone.
std::vector<float> all_costs(const Problem& problem, bool closed = true) {
  std::vector<float> costs;
  std::vector<bool> used(problem.alone.size(), false);
  std::vector<int> partner(problem.alone.size(), -1);
  const auto visit = [&](const auto& self, std::size_t next, float paid) -> void {
    while (next < used.size() && used[next]) ++next;
    if (next == used.size()) {
      if (closed || !comes_back(partner)) costs.push_back(paid);
      return;
    }
    used[next] = true;
    self(self, next, paid + problem.alone[next]);
    for (const Pair& pair : problem.pairs) {
      const auto a = static_cast<std::size_t>(pair.a);
      const auto b = static_cast<std::size_t>(pair.b);
      if (a != next && b != next) continue;
      const std::size_t other = a == next ? b : a;
      if (used[other] || pair.cost >= problem.alone[a] + problem.alone[b]) continue;
      used[other] = true;
      partner[next] = static_cast<int>(other);
      partner[other] = static_cast<int>(next);
      self(self, next, paid + pair.cost);
      partner[next] = partner[other] = -1;
      used[other] = false;
    }
    used[next] = false;
  };
  visit(visit, 0, 0);
  std::sort(costs.begin(), costs.end());
  return costs;
}

float cost_of(const Problem& problem, const Pairing& pairing) {
  float cost = 0;
  for (std::size_t i = 0; i < problem.alone.size(); ++i) {
    const int pair = pairing.pair_of[i];
    if (pair < 0) {
      cost += problem.alone[i];
    } else if (problem.pairs[static_cast<std::size_t>(pair)].a == static_cast<int>(i)) {
      cost += problem.pairs[static_cast<std::size_t>(pair)].cost;
    }
  }
  return cost;
}

TEST(Pairings, AreTheCheapestOfAllInOrder) {
  std::mt19937 random(7);
  for (int round = 0; round < 60; ++round) {
    const Problem problem = random_problem(random, 4 + round % 6, 1 + round % 3);
    const auto expected = all_costs(problem);
    const auto found = cheapest_pairings(problem.alone, problem.pairs, 12);
    ASSERT_EQ(found.size(), std::min<std::size_t>(12, expected.size()));
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_NEAR(found[i].cost, expected[i], 1e-3F) << "round " << round << ", place " << i;
      EXPECT_NEAR(cost_of(problem, found[i]), found[i].cost, 1e-3F);
    }
  }
}

TEST(Pairings, WithoutClosedChainsAreTheCheapestOfTheOthersInOrder) {
  std::mt19937 random(11);
  std::size_t closed_ones = 0;
  for (int round = 0; round < 60; ++round) {
    const Problem problem = random_problem(random, 4 + 2 * (round % 3), 1 + round % 2);
    const auto expected = all_costs(problem, false);
    closed_ones += all_costs(problem).size() - expected.size();
    const auto found = cheapest_pairings(problem.alone, problem.pairs, 12, false);
    ASSERT_EQ(found.size(), std::min<std::size_t>(12, expected.size()));
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_NEAR(found[i].cost, expected[i], 1e-3F) << "round " << round << ", place " << i;
      EXPECT_NEAR(cost_of(problem, found[i]), found[i].cost, 1e-3F);
    }
  }
  EXPECT_GT(closed_ones, 100U);
}

TEST(Pairings, AreDifferentFromEachOther) {
  std::mt19937 random(8);
  const Problem problem = random_problem(random, 12, 2);
  const auto found = cheapest_pairings(problem.alone, problem.pairs, 40);
  std::set<std::vector<int>> seen;
  for (const Pairing& pairing : found) seen.insert(pairing.pair_of);
  EXPECT_GT(found.size(), 10U);
  EXPECT_EQ(seen.size(), found.size());
}

TEST(Pairings, ACycleOfThreeLeavesOneAlone) {
  const Problem triangle{{2, 2, 3}, {{0, 1, 1}, {1, 2, 1}, {0, 2, 1}}};
  const auto found = cheapest_pairings(triangle.alone, triangle.pairs, 1);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_FLOAT_EQ(found[0].cost, 3);  // the dearest one is in the pair
  EXPECT_GE(found[0].pair_of[2], 0);
}

TEST(Pairings, OfNothingAreOneOfNothing) {
  const auto found = cheapest_pairings({}, {}, 5);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].cost, 0);
}

TEST(Pairings, ATangleOfManyEndsInTimeWithAValidAnswer) {
  std::mt19937 random(9);
  const Problem problem = random_problem(random, 300, 4);
  const auto found = cheapest_pairings(problem.alone, problem.pairs, 3);
  ASSERT_FALSE(found.empty());
  float all_alone = 0;
  for (const float cost : problem.alone) all_alone += cost;
  EXPECT_LT(found[0].cost, all_alone);
  EXPECT_NEAR(cost_of(problem, found[0]), found[0].cost, 0.05F);
}

}  // namespace
}  // namespace flowdlo::path
