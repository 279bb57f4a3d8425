#include "path/search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace flowdlo::path {
namespace {

Strands strands_of(int count, float covers_px) {
  Strands strands;
  strands.width_px = strands.scale_px = 10;
  for (int i = 0; i < count; ++i) {
    Strand strand;
    strand.covers_px = covers_px;
    strands.list.push_back(strand);
  }
  return strands;
}

void join(std::vector<std::vector<Bond>>& bonds, int a, int b, float cost) {
  bonds[static_cast<std::size_t>(a)].push_back({b, cost, true});
  bonds[static_cast<std::size_t>(b)].push_back({a, cost, true});
}

// Every order and direction, by brute force; all strands end in tips.
float cheapest(const Strands& strands, const std::vector<std::vector<Bond>>& bonds) {
  const auto n = static_cast<int>(strands.list.size());
  float best = 1e9F;
  std::vector<bool> used(strands.list.size(), false);
  const auto visit = [&](const auto& self, int exit, float paid, float left) -> void {
    best = std::min(best, paid + left);
    for (const Bond& bond : bonds[static_cast<std::size_t>(exit)]) {
      const auto s = static_cast<std::size_t>(bond.to / 2);
      if (used[s]) continue;
      used[s] = true;
      self(self, bond.to ^ 1, paid + bond.cost, left - 1.5F * strands.list[s].covers_px / 10);
      used[s] = false;
    }
  };
  float total = 0;
  for (const Strand& strand : strands.list) total += 1.5F * strand.covers_px / 10;
  for (int end = 0; end < 2 * n; ++end) {
    used[static_cast<std::size_t>(end / 2)] = true;
    visit(visit, end ^ 1, 0,
          total - 1.5F * strands.list[static_cast<std::size_t>(end / 2)].covers_px / 10);
    used[static_cast<std::size_t>(end / 2)] = false;
  }
  return best;
}

TEST(Search, FindsTheCheapestOfAllTraversals) {
  std::mt19937 random(3);
  for (int round = 0; round < 30; ++round) {
    const Strands strands = strands_of(6, 40);
    std::vector<std::vector<Bond>> bonds(12);
    for (int a = 0; a < 12; ++a) {
      for (int b = a + 1; b < 12; ++b) {
        if (a / 2 != b / 2 && random() % 3 != 0) {
          join(bonds, a, b, 0.1F + 0.01F * static_cast<float>(random() % 900));
        }
      }
    }
    for (auto& list : bonds) {
      std::sort(list.begin(), list.end(),
                [](const Bond& a, const Bond& b) { return a.cost < b.cost; });
    }

    const auto found = search(strands, bonds, 3);

    ASSERT_FALSE(found.empty());
    EXPECT_NEAR(found.front().cost, cheapest(strands, bonds), 1e-3F) << round;
  }
}

TEST(Search, UsesNoStrandTwice) {
  const Strands strands = strands_of(5, 50);
  std::vector<std::vector<Bond>> bonds(10);
  for (int a = 0; a < 10; ++a) {
    for (int b = a + 1; b < 10; ++b) {
      if (a / 2 != b / 2) join(bonds, a, b, 1);
    }
  }
  for (const Traversal& traversal : search(strands, bonds, 8)) {
    std::vector<int> seen;
    for (const int end : traversal.enters) seen.push_back(end / 2);
    std::sort(seen.begin(), seen.end());
    EXPECT_EQ(std::adjacent_find(seen.begin(), seen.end()), seen.end());
  }
}

TEST(Search, LeavesOutAPieceThatCostsMoreThanItCovers) {
  const Strands strands = strands_of(2, 20);
  std::vector<std::vector<Bond>> bonds(4);
  join(bonds, 1, 2, 50);
  EXPECT_EQ(search(strands, bonds, 2).front().enters.size(), 1U);
}

TEST(Search, TakesALongPieceForTheSamePrice) {
  const Strands strands = strands_of(2, 800);
  std::vector<std::vector<Bond>> bonds(4);
  join(bonds, 1, 2, 50);
  EXPECT_EQ(search(strands, bonds, 2).front().enters.size(), 2U);
}

TEST(Search, AnswersWithinItsBoundsForHundredsOfStrands) {
  const Strands strands = strands_of(400, 50);
  std::vector<std::vector<Bond>> bonds(800);
  std::mt19937 random(5);
  for (int a = 0; a < 800; ++a) {
    for (int k = 0; k < 3; ++k) {
      const auto b = static_cast<int>(random() % 800);
      if (a / 2 != b / 2) join(bonds, a, b, 1);
    }
  }
  EXPECT_FALSE(search(strands, bonds, 4).empty());
}

}  // namespace
}  // namespace flowdlo::path
