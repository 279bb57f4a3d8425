#include "path/search.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "geometry/polyline.hpp"

namespace flowdlo::path {
namespace {

using Bonds = std::vector<std::vector<Bond>>;

constexpr float kStop = 1.75F;  // what an end of a rope costs here,
constexpr float kRope = 2 * kStop;

// Strands of forty widths.
Strands strands_of(std::size_t count) {
  Strands strands;
  strands.width_px = strands.scale_px = 10;
  strands.list.resize(count);
  for (Strand& strand : strands.list) strand.covers_px = 400;
  return strands;
}

// What these bonds cost, where each end costs kStop.
Prices prices_of(Bonds bonds) {
  const std::size_t ends = bonds.size();
  return {std::move(bonds), std::vector<float>(ends, kStop)};
}

void join(Bonds& bonds, int a, int b, float cost) {
  bonds[static_cast<std::size_t>(a)].push_back({b, cost});
  bonds[static_cast<std::size_t>(b)].push_back({a, cost});
}

// Two strands that follow each other across a gap of that cost.
std::vector<RopeSet> two_strands(float gap, int ropes) {
  Bonds bonds(4);
  join(bonds, 1, 2, gap);
  return search_sets(strands_of(2), prices_of(bonds), ropes, 4);
}

TEST(RopeSets, AGapThatCostsLessThanARopeJoinsTwoStrands) {
  const auto sets = two_strands(kRope - 0.5F, 0);
  ASSERT_FALSE(sets.empty());
  ASSERT_EQ(sets[0].ways.size(), 1U);
  EXPECT_EQ(sets[0].ways[0].enters, (std::vector<int>{0, 2}));
  EXPECT_FLOAT_EQ(sets[0].cost, 2 * kRope - 0.5F);
}

TEST(RopeSets, AGapThatCostsMoreThanARopePartsThem) {
  const auto sets = two_strands(kRope + 0.5F, 0);
  ASSERT_FALSE(sets.empty());
  EXPECT_EQ(sets[0].ways.size(), 2U);
  EXPECT_FLOAT_EQ(sets[0].cost, 2 * kRope);
}

TEST(RopeSets, TheNumberAskedForIsFoundWhateverGapsCost) {
  EXPECT_EQ(two_strands(kRope + 9, 1).at(0).ways.size(), 1U);
  EXPECT_EQ(two_strands(0.1F, 2).at(0).ways.size(), 2U);
}

TEST(RopeSets, ANumberThatTheStrandsCannotBeHasNoSet) { EXPECT_TRUE(two_strands(0.1F, 3).empty()); }

TEST(RopeSets, RopesThatCrossGoStraightOn) {
  Strands strands = strands_of(4);  // 0 goes on as 1, 2 as 3; all meet at one crossing
  for (const int end : {1, 2, 5, 6}) {
    strands.list[static_cast<std::size_t>(end / 2)]
        .ends[static_cast<std::size_t>(end % 2)]
        .crossing = 0;
  }
  Bonds bonds(8);
  join(bonds, 1, 2, 0.1F);
  join(bonds, 5, 6, 0.2F);
  for (const int a : {1, 2}) {
    for (const int b : {5, 6}) join(bonds, a, b, 2.0F);
  }
  const auto sets = search_sets(strands, prices_of(bonds), 0, 8);
  ASSERT_FALSE(sets.empty());
  ASSERT_EQ(sets[0].ways.size(), 2U);
  EXPECT_EQ(sets[0].ways[0].enters, (std::vector<int>{0, 2}));
  EXPECT_EQ(sets[0].ways[1].enters, (std::vector<int>{4, 6}));
  EXPECT_NEAR(sets[0].cost, 2 * kRope + 0.3F, 1e-4F);
}

/// Strand 0 comes from below and strand 1 goes on above, strand 2 is nearly a ring between them, to
/// the right; all four inner ends lie together. Straight on is one rope with a loop.
Strands rope_with_loop() {
  Strands strands = strands_of(3);
  const auto lay = [&](std::size_t s, const std::vector<Eigen::Vector2f>& points) {
    strands.list[s].ends[0].point_px = points.front();
    strands.list[s].ends[1].point_px = points.back();
    strands.list[s].points_px = geometry::resample(points, 200);
  };
  lay(0, {{0, 100}, {0, 60}, {0, 10}});
  lay(1, {{0, -10}, {0, -60}, {0, -100}});
  lay(2, {{6, 8}, {60, 60}, {120, 0}, {60, -60}, {6, -8}});
  return strands;
}

Prices loop_prices(float through, float back) {
  Bonds bonds(6);
  join(bonds, 1, 5, through);  // from below into the ring's upper end,
  join(bonds, 2, 4, through);  // and from its lower one on above
  join(bonds, 1, 2, back);     // or past it,
  join(bonds, 4, 5, back);     // which closes
  Prices prices = prices_of(bonds);
  for (const std::size_t inner : {1, 2, 4, 5})
    prices.stops[inner] = 3 * kStop;  // no rope seems to end there
  return prices;
}

TEST(RopeSets, ARingThatARopeTouchesIsALoopUnlessThatCostsMuchMore) {
  const Strands strands = rope_with_loop();
  const float gain = kTouchEnergy + kRingEnergy;
  const auto loop = search_sets(strands, loop_prices(1 + 0.5F * gain - 0.1F, 1), 0, 4);
  ASSERT_FALSE(loop.empty());
  EXPECT_EQ(loop[0].ways.size(), 1U) << "within what touching costs";
  const auto ring = search_sets(strands, loop_prices(1 + 0.5F * gain + 0.1F, 1), 0, 4);
  ASSERT_FALSE(ring.empty());
  ASSERT_EQ(ring[0].ways.size(), 2U);
  EXPECT_TRUE(ring[0].ways[0].closed || ring[0].ways[1].closed);
  EXPECT_NEAR(ring[0].cost, kRope + gain + 2, 1e-4F);
}

/// Four strands that come together from all sides: 0 and 1 from left and right, 2 and 3 from below
/// and above.
TEST(RopeSets, StrandsThatComeTogetherRatherCrossThanTouch) {
  Strands strands = strands_of(4);
  const std::vector<Eigen::Vector2f> inner{{-6, 0}, {6, 0}, {0, 6}, {0, -6}};
  for (std::size_t s = 0; s < 4; ++s) {
    strands.list[s].ends[0].point_px = 20 * inner[s];
    strands.list[s].ends[1].point_px = inner[s];
  }
  const auto by = [&](float through, float aside) {
    Bonds bonds(8);
    join(bonds, 1, 3, through);
    join(bonds, 5, 7, through);
    for (const int a : {1, 3}) {
      for (const int b : {5, 7}) join(bonds, a, b, aside);
    }
    return search_sets(strands, prices_of(bonds), 2, 4).at(0);
  };
  const RopeSet crossing = by(1 + 0.5F * kTouchEnergy - 0.1F, 1);
  EXPECT_EQ(crossing.ways[0].enters, (std::vector<int>{0, 3}));
  EXPECT_NEAR(crossing.cost, 2 * kRope + 2 + kTouchEnergy - 0.2F, 1e-4F);
  const RopeSet touching = by(1 + 0.5F * kTouchEnergy + 0.1F, 1);
  EXPECT_NE(touching.ways[0].enters, (std::vector<int>{0, 3}));
  EXPECT_NEAR(touching.cost, 2 * kRope + 2 + kTouchEnergy, 1e-4F);
}

TEST(RopeSets, AWayThatComesBackToItsBeginningIsClosed) {
  Bonds bonds(4);
  join(bonds, 1, 2, 0.1F);
  join(bonds, 3, 0, 0.1F);
  const auto sets = search_sets(strands_of(2), prices_of(bonds), 0, 4);
  ASSERT_FALSE(sets.empty());
  ASSERT_EQ(sets[0].ways.size(), 1U);
  EXPECT_TRUE(sets[0].ways[0].closed);
  EXPECT_NEAR(sets[0].cost, 0.2F + kRingEnergy, 1e-4F);
}

TEST(RopeSets, AStrandThatIsSeenToBeARingPaysNothingForIt) {
  Strands strands = strands_of(1);
  strands.list[0].ring = true;
  const auto sets = search_sets(strands, prices_of(Bonds(2)), 0, 4);
  ASSERT_FALSE(sets.empty());
  EXPECT_TRUE(sets[0].ways.at(0).closed);
  EXPECT_NEAR(sets[0].cost, 0, 1e-4F);
}

TEST(RopeSets, WhatIsTooShortForARingStaysOpen) {
  Strands strands = strands_of(1);
  strands.list[0].covers_px = 60;  // six widths
  Bonds bonds(2);
  join(bonds, 0, 1, 0.1F);
  const auto open = search_sets(strands, prices_of(bonds), 0, 1);
  ASSERT_FALSE(open.empty());
  EXPECT_FALSE(open[0].ways.at(0).closed);
  strands.list[0].covers_px = 100;
  EXPECT_TRUE(search_sets(strands, prices_of(bonds), 0, 1).at(0).ways.at(0).closed);
}

TEST(RopeSets, AShortStrandIsLeftOutAndALongOneIsARope) {
  Strands strands = strands_of(2);
  strands.list[1].covers_px = 12;  // hardly more than a width
  const auto with_speck = search_sets(strands, prices_of(Bonds(4)), 0, 1);
  ASSERT_FALSE(with_speck.empty());
  EXPECT_EQ(with_speck[0].ways.size(), 1U);
  EXPECT_FLOAT_EQ(with_speck[0].cost, kRope + left_out_energy(strands.list[1], strands));
  strands.list[1].covers_px = 60;
  EXPECT_EQ(search_sets(strands, prices_of(Bonds(4)), 0, 1).at(0).ways.size(), 2U);
}

/// Two strands of forty widths side by side, so many pixels apart; a rope's ends cost kStop each.
Strands side_by_side(float apart_px) {
  Strands strands = strands_of(2);
  const std::vector<Eigen::Vector2f> line{{0, 0}, {200, 40}, {400, 0}};
  for (std::size_t s = 0; s < 2; ++s) {
    auto& points = strands.list[s].points_px;
    points = geometry::resample(line, 400);
    for (Eigen::Vector2f& p : points) p.y() += static_cast<float>(s) * apart_px;
    strands.list[s].ends[0].point_px = points.front();
    strands.list[s].ends[1].point_px = points.back();
  }
  return strands;
}

TEST(RopeSets, WhatLiesWithinAnotherRopeIsNoRopeOfItsOwn) {
  const Prices prices = prices_of(Bonds(4));
  const auto within = search_sets(side_by_side(6), prices, 0, 4);  // of ropes that are 10 px wide
  ASSERT_FALSE(within.empty());
  EXPECT_EQ(within[0].ways.size(), 1U);
  EXPECT_FLOAT_EQ(within[0].cost, kRope) << "nothing is left out";
  const auto beside = search_sets(side_by_side(10), prices, 0, 4);
  ASSERT_FALSE(beside.empty());
  EXPECT_EQ(beside[0].ways.size(), 2U) << "ropes that touch are two";
}

TEST(RopeSets, ARopeThatLiesOnAnotherForAPartOfItsWayIsOne) {
  Strands strands = side_by_side(6);
  auto& points = strands.list[1].points_px;
  for (std::size_t i = 0; i < 80; ++i) points[i].y() += 40 - 0.5F * static_cast<float>(i);
  const auto sets = search_sets(strands, prices_of(Bonds(4)), 0, 4);
  ASSERT_FALSE(sets.empty());
  EXPECT_EQ(sets[0].ways.size(), 2U) << "leaving out what lies bare costs more than a rope";
}

TEST(RopeSets, RopesThatCrossDoNotLieOnEachOther) {
  Strands strands = side_by_side(0);
  for (Eigen::Vector2f& p : strands.list[1].points_px) p = {200 - p.y(), p.x() - 200};
  const auto sets = search_sets(strands, prices_of(Bonds(4)), 0, 4);
  ASSERT_FALSE(sets.empty());
  EXPECT_EQ(sets[0].ways.size(), 2U);
}

TEST(RopeSets, SetsThatDifferInWhatWasSeenTwiceAreOne) {
  Strands strands = side_by_side(6);
  strands.list.push_back(strands.list[1]);  // a third line within the same rope,
  strands.list[2].covers_px = 30;           // that may also be left out
  const auto sets = search_sets(strands, prices_of(Bonds(6)), 0, 8);
  ASSERT_FALSE(sets.empty());
  for (std::size_t i = 0; i < sets.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto same = [](const Traversal& a, const Traversal& b) { return a.enters == b.enters; };
      EXPECT_FALSE(std::equal(sets[i].ways.begin(), sets[i].ways.end(), sets[j].ways.begin(),
                              sets[j].ways.end(), same));
    }
  }
}

TEST(RopeSets, NoStrandsAreNoSet) {
  Strands none;
  EXPECT_TRUE(search_sets(none, {}, 0, 4).empty());
  EXPECT_TRUE(search_sets(none, {}, 2, 4).empty());
}

}  // namespace
}  // namespace flowdlo::path
