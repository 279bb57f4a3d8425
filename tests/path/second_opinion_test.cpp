#include "path/second_opinion.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "path/strand_reading.hpp"
#include "seen.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;
using testing::show_tip;
using testing::straight_axis;

constexpr int kLeft = 40;  // of the region in the frame

Path level(int from, int to, float v = 60) {
  Path path;
  for (int u = from; u <= to; ++u) path.points_px.emplace_back(static_cast<float>(u), v);
  path.bridged.assign(path.points_px.size(), 0);
  return path;
}

// Three level strands of a region, 8 px wide: at 10 to 60 and 90 to 140 one behind the other, and
// below them.
Strands strands_in(Region& region) {
  region.offset_px = {kLeft, 0};
  Strands strands;
  strands.width_px = strands.scale_px = 8;
  for (const Path& path : {level(10, 60), level(90, 140), level(10, 140, 100)}) {
    strands.list.emplace_back().points_px = path.points_px;
  }
  return strands;
}

TEST(SecondOpinion, WhatOnePathLeadsAlongGoesOn) {
  Region region;
  const Strands strands = strands_in(region);
  const Opinion opinion = opinion_on(strands, {{{level(kLeft + 10, kLeft + 140, 62)}, 1}}, region);
  EXPECT_EQ(opinion.goes_on, (std::vector<float>{0, 1, 1, 0, 0, 0}));
  EXPECT_EQ(opinion.known, (std::vector<float>{1, 1, 1, 1, 0, 0}));
  EXPECT_EQ(opinion.against(2, 1), 0);
  EXPECT_EQ(opinion.against(0, 3), 1);
  EXPECT_EQ(opinion.against(1, 4), 1);
  EXPECT_EQ(opinion.against(4, 5), 0) << "of a strand that it does not know it says nothing";
}

TEST(SecondOpinion, GuessesCountByTheirShares) {
  Region region;
  const Strands strands = strands_in(region);
  const std::vector<Path> parted{level(kLeft + 10, kLeft + 60), level(kLeft + 90, kLeft + 140)};
  const Opinion opinion =
      opinion_on(strands, {{parted, 0.75F}, {{level(kLeft + 10, kLeft + 140)}, 0.25F}}, region);
  EXPECT_FLOAT_EQ(opinion.goes_on[1], 0.25F);
  EXPECT_FLOAT_EQ(opinion.known[1], 1);
  EXPECT_FLOAT_EQ(opinion.against(1, 2), 0.75F);
}

TEST(SecondOpinion, ARingGoesOnFromItsEndToItsBegin) {
  Region region;
  const Strands strands = strands_in(region);
  Path ring = level(kLeft + 10, kLeft + 140);
  ring.closed = true;
  const Opinion opinion = opinion_on(strands, {{{ring}, 1}}, region);
  EXPECT_EQ(opinion.against(0, 3), 0);
  EXPECT_EQ(opinion.goes_on[3], 1);
}

TEST(SecondOpinion, WithoutGuessesItSaysNothing) {
  Region region;
  const Opinion opinion = opinion_on(strands_in(region), {}, region);
  EXPECT_TRUE(opinion.goes_on.empty());
  EXPECT_EQ(opinion.against(1, 2), 0);
}

TEST(SecondOpinion, AGapThatTheFieldPartsIsBridgedWhereTheMaskGoesOn) {
  const auto one = straight_axis({20, 60}, {100, 60});
  const auto two = straight_axis({220, 60}, {300, 60});
  test::Seen seen({one, two});
  for (const Vector2f& tip : {one.front(), one.back(), two.front(), two.back()}) {
    show_tip(seen.field.channels, tip);
  }
  const auto axes = field::axes(seen.field);
  const auto alone = trace_ropes(seen.canvas.frame(), axes, 0);
  ASSERT_TRUE(alone) << alone.error().message;
  EXPECT_EQ(alone->ropes.size(), 2U);
  const auto told = trace_ropes(seen.canvas.frame(), axes, 0, {{{level(20, 300)}, 1}});
  ASSERT_TRUE(told) << told.error().message;
  EXPECT_EQ(told->ropes.size(), 1U);
}

}  // namespace
}  // namespace flowdlo::path
