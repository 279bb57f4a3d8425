#include "path/search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>

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
  bonds[static_cast<std::size_t>(a)].push_back({b, cost});
  bonds[static_cast<std::size_t>(b)].push_back({a, cost});
}

// What these bonds cost, where ends cost nothing.
Prices free_ends(std::vector<std::vector<Bond>> bonds) {
  const std::size_t ends = bonds.size();
  return {std::move(bonds), std::vector<float>(ends, 0)};
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
      self(self, bond.to ^ 1, paid + bond.cost,
           left - kLeftOutEnergy * strands.list[s].covers_px / 10);
      used[s] = false;
    }
  };
  float total = 0;
  for (const Strand& strand : strands.list) total += kLeftOutEnergy * strand.covers_px / 10;
  for (int end = 0; end < 2 * n; ++end) {
    used[static_cast<std::size_t>(end / 2)] = true;
    visit(visit, end ^ 1, 0,
          total - kLeftOutEnergy * strands.list[static_cast<std::size_t>(end / 2)].covers_px / 10);
    used[static_cast<std::size_t>(end / 2)] = false;
  }
  return best;
}

TEST(Search, TheOnlyRopeRatherComesBackIntoTheImageThanItsTipsAreJoined) {
  Strands strands = strands_of(2, 100);  // each from a tip, 0 and 2, to the border, 1 and 3
  for (const int end : {1, 3})
    strands.list[static_cast<std::size_t>(end / 2)].ends[1].leaves = true;
  std::vector<std::vector<Bond>> bonds(4);
  join(bonds, 0, 2, 1);
  join(bonds, 1, 3, 4);
  const auto ways = search(strands, {bonds, {1, 0, 1, 0}}, 2);
  ASSERT_EQ(ways.size(), 2U);
  EXPECT_THAT(ways.front().enters,
              testing::AnyOf(testing::ElementsAre(0, 3), testing::ElementsAre(2, 1)));
  EXPECT_FLOAT_EQ(ways.front().cost, 1 + 1 + 4);
  EXPECT_FLOAT_EQ(ways.back().cost, 1 + 2 * kLeavesEnergy);
}

TEST(SearchSets, OneOfSeveralRopesMayEndAtTheBorder) {
  Strands strands = strands_of(1, 100);
  strands.list[0].ends[0].leaves = strands.list[0].ends[1].leaves = true;
  const auto sets = search_sets(strands, free_ends(std::vector<std::vector<Bond>>(2)), 0, 1);
  ASSERT_EQ(sets.size(), 1U);
  EXPECT_FLOAT_EQ(sets.front().cost, 0);
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

    const auto found = search(strands, free_ends(bonds), 3);

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
  for (const Traversal& traversal : search(strands, free_ends(bonds), 8)) {
    std::vector<int> seen;
    for (const int end : traversal.enters) seen.push_back(end / 2);
    std::sort(seen.begin(), seen.end());
    EXPECT_EQ(std::adjacent_find(seen.begin(), seen.end()), seen.end());
  }
}

TEST(SearchRings, FindsTheCheapestWayThatClosesWithTheBondThatClosesIt) {
  const Strands strands = strands_of(3, 400);
  std::vector<std::vector<Bond>> bonds(6);
  join(bonds, 1, 2, 1);  // the first and the second close in two bonds,
  join(bonds, 3, 0, 2);
  join(bonds, 3, 4, 30);  // all three in dearer ones, which still cost less than a strand left out
  join(bonds, 5, 0, 40);
  const auto ways = search_rings(strands, free_ends(bonds), 4);
  ASSERT_GE(ways.size(), 2U);
  for (const Traversal& way : ways) EXPECT_TRUE(way.closed);
  EXPECT_EQ(ways.front().enters.size(), 3U);
  EXPECT_FLOAT_EQ(ways.front().cost, 1 + 30 + 40);
  EXPECT_EQ(ways[1].enters.size(), 2U);
  EXPECT_FLOAT_EQ(ways[1].cost, 1 + 2 + kLeftOutEnergy * 400 / 10);
}

TEST(SearchRings, OneStrandClosesByItsTwoEndsAndARingWithoutABond) {
  Strands strands = strands_of(1, 400);
  std::vector<std::vector<Bond>> bonds(2);
  join(bonds, 0, 1, 5);
  const auto parted = search_rings(strands, free_ends(bonds), 4);
  ASSERT_EQ(parted.size(), 1U);
  EXPECT_TRUE(parted.front().closed);
  EXPECT_FLOAT_EQ(parted.front().cost, 5);
  strands.list.front().ring = true;
  const auto whole = search_rings(strands, free_ends(std::vector<std::vector<Bond>>(2)), 4);
  ASSERT_EQ(whole.size(), 1U);
  EXPECT_TRUE(whole.front().closed);
  EXPECT_FLOAT_EQ(whole.front().cost, 0);
}

TEST(SearchRings, AreNoneWhereNothingClosesOrRopesWouldBendTooTightly) {
  std::vector<std::vector<Bond>> bonds(4);
  join(bonds, 1, 2, 1);
  EXPECT_TRUE(search_rings(strands_of(2, 400), free_ends(bonds), 4).empty());
  std::vector<std::vector<Bond>> tight(2);
  join(tight, 0, 1, 1);
  EXPECT_TRUE(search_rings(strands_of(1, 40), free_ends(tight), 4).empty());
}

TEST(Search, LeavesOutAPieceThatCostsMoreThanItCovers) {
  const Strands strands = strands_of(2, 20);
  std::vector<std::vector<Bond>> bonds(4);
  join(bonds, 1, 2, 50);
  EXPECT_EQ(search(strands, free_ends(bonds), 2).front().enters.size(), 1U);
}

TEST(Search, TakesALongPieceForTheSamePrice) {
  const Strands strands = strands_of(2, 800);
  std::vector<std::vector<Bond>> bonds(4);
  join(bonds, 1, 2, 50);
  EXPECT_EQ(search(strands, free_ends(bonds), 2).front().enters.size(), 2U);
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
  EXPECT_FALSE(search(strands, free_ends(bonds), 4).empty());
}

/// Three strands that meet at side 1, in any pairs at the same price; each tip lies 100 px out.
struct Fork {
  Fork() : strands(strands_of(3, 100)), bonds(6) {
    const std::array<Eigen::Vector2f, 3> tips{{{100, 0}, {0, 100}, {-100, 0}}};
    for (std::size_t s = 0; s < 3; ++s) {
      strands.list[s].ends[0].point_px = tips[s];
      for (std::size_t other = s + 1; other < 3; ++other) {
        join(bonds, static_cast<int>(2 * s + 1), static_cast<int>(2 * other + 1), 1);
      }
    }
  }
  /// The tips between which the cheapest traversal runs.
  [[nodiscard]] std::set<int> tips(const std::vector<Eigen::Vector2f>& ends) const {
    const auto enters = search(strands, free_ends(bonds), 1, ends).front().enters;
    return {enters.front(), enters.back() ^ 1};
  }

  Strands strands;
  std::vector<std::vector<Bond>> bonds;
};

TEST(Search, EndsWhereTheEndsAreKnownToBe) {
  const Fork fork;
  EXPECT_EQ(fork.tips({{100, 0}, {0, 100}}), (std::set{0, 2}));
  EXPECT_EQ(fork.tips({{-95, 5}, {0, 90}}), (std::set{2, 4}));
  EXPECT_EQ(fork.tips({{-100, 0}, {100, 0}}), (std::set{0, 4}));
}

TEST(Search, OneKnownEndLeavesTheOtherFree) {
  for (int tip = 0; tip < 3; ++tip) {
    const Fork fork;
    const auto end = fork.strands.list[static_cast<std::size_t>(tip)].ends[0].point_px;
    EXPECT_THAT(fork.tips({end}), testing::Contains(2 * tip));
  }
}

TEST(Search, EndsFarFromEveryStrandChangeNothingButTheCost) {
  const Fork fork;
  const auto plain = search(fork.strands, free_ends(fork.bonds), 3);
  const auto asked = search(fork.strands, free_ends(fork.bonds), 3, {{4000, 4000}});
  ASSERT_EQ(plain.size(), asked.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    EXPECT_EQ(plain[i].enters, asked[i].enters);
    EXPECT_FLOAT_EQ(asked[i].cost, plain[i].cost + 2 * kElsewhere);
  }
}

}  // namespace
}  // namespace flowdlo::path
