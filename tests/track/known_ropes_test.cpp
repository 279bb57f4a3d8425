#include "track/known_ropes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "track/curves.hpp"

namespace flowdlo::track {
namespace {

using testing::backwards;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::ring;
using testing::rope;
using testing::straight;

Ropes ropes(const std::vector<Centerline>& nodes) {
  Ropes result;
  for (const Centerline& each : nodes) result.ropes.push_back(rope(each));
  return result;
}

TEST(KnownRopes, TheFirstFrameNumbersItsRopesInTheirOrder) {
  KnownRopes known({});
  const auto seen = known.recognise(ropes({straight(0, 0), straight(0, 0.2F)}));
  EXPECT_THAT(seen.numbers, ElementsAre(1, 2));
  EXPECT_THAT(seen.missing, IsEmpty());
}

TEST(KnownRopes, ARopeKeepsItsNumberWhereTheOrderChanges) {
  KnownRopes known({});
  (void)known.recognise(ropes({straight(0, 0), straight(0, 0.2F)}));
  auto frame = ropes({straight(0, 0.21F), straight(0, 0.01F)});
  frame.instances = {0, 1, 2};
  const auto seen = known.recognise(std::move(frame));
  EXPECT_THAT(seen.numbers, ElementsAre(1, 2));
  EXPECT_FLOAT_EQ(seen.found.ropes[0].nodes[0].y, 0.01F);
  EXPECT_FLOAT_EQ(seen.found.ropes[1].nodes[0].y, 0.21F);
  EXPECT_THAT(seen.found.instances, ElementsAre(0, 2, 1));
}

TEST(KnownRopes, AllTogetherMoveLeast) {
  // The first is nearer to where the second was than that one is, but it has nowhere else to go.
  KnownRopes known({.most_moved_m = 0.1});
  (void)known.recognise(ropes({straight(0, 0), straight(0, 0.08F)}));
  const auto seen = known.recognise(ropes({straight(0, 0.07F), straight(0, 0.15F)}));
  EXPECT_THAT(seen.numbers, ElementsAre(1, 2));
  EXPECT_FLOAT_EQ(seen.found.ropes[0].nodes[0].y, 0.07F);
}

TEST(KnownRopes, WhatMovedTooFarIsAnotherRope) {
  KnownRopes known({.most_moved_m = 0.05});
  (void)known.recognise(ropes({straight(0, 0)}));
  const auto seen = known.recognise(ropes({straight(0, 0.06F)}));
  EXPECT_THAT(seen.numbers, ElementsAre(2));
  EXPECT_THAT(seen.missing, ElementsAre(1));
}

TEST(KnownRopes, ARopeThatComesBackInTimeHasItsNumber) {
  KnownRopes known({.most_moved_m = 0.1, .patience = 2});
  (void)known.recognise(ropes({straight(0, 0), straight(0, 0.3F)}));
  for (int frame = 0; frame < 2; ++frame) {
    EXPECT_THAT(known.recognise(ropes({straight(0, 0)})).missing, ElementsAre(2));
  }
  EXPECT_THAT(known.recognise(ropes({straight(0, 0), straight(0, 0.3F)})).numbers,
              ElementsAre(1, 2));
  for (int frame = 0; frame < 3; ++frame) (void)known.recognise(ropes({straight(0, 0)}));
  const auto late = known.recognise(ropes({straight(0, 0), straight(0, 0.3F)}));
  EXPECT_THAT(late.numbers, ElementsAre(1, 3));
  EXPECT_THAT(late.missing, IsEmpty());
}

TEST(KnownRopes, FramesThatShowNoneCountAsMissed) {
  KnownRopes known({.most_moved_m = 0.1, .patience = 1});
  (void)known.recognise(ropes({straight(0, 0)}));
  known.miss_all();
  EXPECT_THAT(known.recognise(ropes({straight(0, 0)})).numbers, ElementsAre(1));
  known.miss_all();
  known.miss_all();
  EXPECT_THAT(known.recognise(ropes({straight(0, 0)})).numbers, ElementsAre(2));
}

TEST(KnownRopes, EndsKeepTheirOrderAndCrossingsFollow) {
  KnownRopes known({});
  (void)known.recognise(ropes({straight(0, 0), straight(0, 0.2F)}));
  auto frame = ropes({backwards(straight(0, 0.2F)), straight(0, 0)});
  frame.crossings = {{.over = 0, .under = 1, .over_at_m = 0.1F, .under_at_m = 0.2F}};
  frame.ropes[0].alternatives = {{.nodes = backwards(straight(0, 0.25F))}};
  const auto seen = known.recognise(std::move(frame));
  EXPECT_FLOAT_EQ(seen.found.ropes[1].nodes.front().x, 0);
  EXPECT_TRUE(seen.found.ropes[1].reversed);
  EXPECT_FLOAT_EQ(seen.found.ropes[1].alternatives[0].nodes.front().x, 0);
  ASSERT_EQ(seen.found.crossings.size(), 1U);
  EXPECT_EQ(seen.found.crossings[0].over, 1);
  EXPECT_EQ(seen.found.crossings[0].under, 0);
  EXPECT_NEAR(seen.found.crossings[0].over_at_m, 0.4, 1e-5);
  EXPECT_NEAR(seen.found.crossings[0].under_at_m, 0.2, 1e-5);
}

TEST(KnownRopes, ARingKeepsItsFirstNode) {
  KnownRopes known({});
  Ropes frame;
  frame.ropes = {rope(ring(0), true)};
  (void)known.recognise(frame);
  frame.ropes = {rope(ring(1.0 / 3), true)};
  const auto seen = known.recognise(frame);
  EXPECT_THAT(seen.numbers, ElementsAre(1));
  EXPECT_NEAR(seen.found.ropes[0].nodes[0].x, 0.2, 1e-5);
  EXPECT_EQ(seen.found.ropes[0].support[0], 42);
  EXPECT_EQ(seen.found.ropes[0].nodes.front(), seen.found.ropes[0].nodes.back());
}

TEST(KnownRopes, RopesThatFlickerAreForgottenInTheEnd) {
  KnownRopes known({.most_moved_m = 0.01, .patience = 1000000});
  std::size_t missing = 0;
  for (int frame = 0; frame < 200; ++frame) {
    missing =
        known.recognise(ropes({straight(0, 0.1F * static_cast<float>(frame))})).missing.size();
  }
  EXPECT_EQ(missing, static_cast<std::size_t>(kMostRopes));
}

TEST(KnownRopes, WhatIsForgottenIsNewAndNumbersGoOn) {
  KnownRopes known({});
  (void)known.recognise(ropes({straight(0, 0)}));
  known.forget();
  EXPECT_THAT(known.recognise(ropes({straight(0, 0)})).numbers, ElementsAre(2));
}

}  // namespace
}  // namespace flowdlo::track
