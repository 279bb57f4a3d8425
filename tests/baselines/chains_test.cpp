#include "baselines/chains.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "baselines/drawn.hpp"

namespace flowdlo::baselines {
namespace {

using test::drawn;
using testing::SizeIs;

// A row of points 10 px apart.
Chain row(int x, int y, int count) {
  Chain chain;
  for (int i = 0; i < count; ++i) chain.emplace_back(x + 10 * i, y);
  return chain;
}

std::vector<cv::Point> slope() {  // no line that the contour's approximation would shorten
  std::vector<cv::Point> points;
  for (int i = 0; i <= 60; ++i)
    points.emplace_back(40 + 4 * i, 120 + cvRound(30 * std::sin(0.05 * i)));
  return points;
}

TEST(Chains, ABranchAppearsOnceASide) {
  const auto chains = chains_of(drawn(slope(), 1));
  double sum = 0;
  for (const Chain& chain : chains) {
    for (std::size_t i = 1; i < chain.size(); ++i) sum += cv::norm(chain[i] - chain[i - 1]);
  }
  EXPECT_NEAR(sum, 2 * 245, 60);
}

TEST(Chains, ExactlyStraightSkeletonsHaveNone) {
  EXPECT_THAT(chains_of(drawn({{40, 120}, {280, 120}}, 1)), SizeIs(0));
  EXPECT_THAT(chains_of(drawn({{100, 20}, {100, 220}}, 1)), SizeIs(0));
  EXPECT_THAT(chains_of(drawn({{40, 20}, {200, 180}}, 1)), SizeIs(0));
}

TEST(Chains, ASharpTurnBeginsANewOne) {
  cv::Mat mask = drawn({{40, 60}, {160, 90}}, 1);
  drawn({{160, 90}, {180, 220}}, 1, mask);
  for (const Chain& chain : chains_of(mask)) {
    const bool level = chain.front().y < 95 && chain.back().y < 95;
    const bool steep = chain.front().x > 150 && chain.back().x > 150;
    EXPECT_TRUE(level || steep);
  }
}

TEST(Pruned, OfTwoSidesOneIsLeft) {
  const auto left = pruned({row(20, 100, 8), row(22, 101, 7)}, false);
  ASSERT_TRUE(left);
  ASSERT_THAT(*left, SizeIs(1));
  EXPECT_THAT(left->front(), SizeIs(8));
}

TEST(Pruned, ChainsApartStay) {
  const auto left = pruned({row(20, 100, 8), row(20, 150, 7)}, false);
  ASSERT_TRUE(left);
  EXPECT_THAT(*left, SizeIs(2));
}

// A third chain crosses the bridge over what the first one cut out of the second.
std::vector<Chain> bridged() {
  Chain upright;
  for (int i = 0; i < 12; ++i) upright.emplace_back(65, 45 + 10 * i);
  return {upright, row(20, 100, 10), row(20, 180, 4)};
}

TEST(Pruned, BridgedSegmentIsAKeyErrorInTheFaithfulOne) {
  const auto left = pruned(bridged(), false);
  ASSERT_FALSE(left);
  EXPECT_EQ(left.error().message, "bridged segment has no rectangle");
}

TEST(Pruned, BridgedSegmentIsOneLongSegmentInTheRepairedOne) {
  const auto left = pruned(bridged(), true);
  ASSERT_TRUE(left);
  ASSERT_THAT(*left, SizeIs(3));
  EXPECT_THAT((*left)[1], SizeIs(9));  // one segment of nine went, its neighbours stayed joined
}

}  // namespace
}  // namespace flowdlo::baselines
