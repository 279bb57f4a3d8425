#include "baselines/chain_merge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flowdlo::baselines {
namespace {

using testing::AnyOf;
using testing::SizeIs;

bool in_order(const Chain& chain) {
  bool up = true;
  bool down = true;
  for (std::size_t i = 1; i < chain.size(); ++i) {
    up = up && chain[i].x > chain[i - 1].x;
    down = down && chain[i].x < chain[i - 1].x;
  }
  return up || down;
}

TEST(ChainMerge, OneChainIsTheOrder) {
  const auto order = merged({{{0, 0}, {10, 1}}}, false);
  ASSERT_TRUE(order);
  EXPECT_THAT(*order, SizeIs(2));
}

TEST(ChainMerge, PiecesOfACurveComeInItsOrder) {
  const Chain a{{0, 0}, {10, 1}, {20, 3}};
  const Chain b{{60, 22}, {50, 16}, {40, 11}};  // the other way round
  const Chain c{{80, 38}, {90, 47}, {100, 58}};
  const auto order = merged({b, c, a}, false);
  ASSERT_TRUE(order) << order.error().message;
  EXPECT_THAT(*order, SizeIs(9));
  EXPECT_TRUE(in_order(*order));
}

// Rounding takes the quotient of these two collinear tips beyond 1.
std::vector<Chain> collinear() { return {{{0, 0}, {4, 20}}, {{5, 25}, {9, 45}}}; }

TEST(ChainMerge, CollinearTipsAreNoNumberInTheFaithfulOne) {
  const auto order = merged(collinear(), false);
  ASSERT_FALSE(order);
  EXPECT_EQ(order.error().message, "cost of two tips is not a number");
}

TEST(ChainMerge, CollinearTipsAreMergedByTheRepairedOne) {
  const auto order = merged(collinear(), true);
  ASSERT_TRUE(order);
  EXPECT_TRUE(in_order(*order));
}

TEST(ChainMerge, CoincidentTipsFailInTheFaithfulOneOnly) {
  const std::vector<Chain> chains{{{0, 0}, {10, 1}}, {{10, 1}, {20, 5}}};
  EXPECT_FALSE(merged(chains, false));
  EXPECT_TRUE(merged(chains, true));
}

TEST(ChainMerge, NoChainIsNoOrder) { EXPECT_FALSE(merged({}, true)); }

}  // namespace
}  // namespace flowdlo::baselines
