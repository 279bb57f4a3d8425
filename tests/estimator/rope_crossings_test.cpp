#include "estimator/rope_crossings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "flowdlo/estimate.hpp"

namespace flowdlo {
namespace {

TEST(RopeCrossings, LinesThatCrossBackWithinTwoWidthsDoNotCross) {
  std::vector<Estimate> ropes(2);
  for (std::size_t i = 0; i < kNodes; ++i) {
    const float x = -0.2F + 0.4F * static_cast<float>(i) / (kNodes - 1);
    ropes[0].nodes[i] = {x, 0, 0.5F};
    const bool other_side = i == 31;  // one node strays over the other rope
    ropes[1].nodes[i] = {x, other_side ? -0.001F : 0.004F, 0.51F};
  }
  std::vector<std::uint8_t> mask(640 * 480, 0);
  std::fill_n(mask.begin(), 6400, std::uint8_t{255});
  const Frame frame{640, 480, {600, 600, 320, 240}, {}, mask, {}};
  EXPECT_TRUE(estimator::rope_crossings(ropes, frame).empty());
  for (std::size_t i = 32; i < kNodes; ++i) ropes[1].nodes[i].y = -0.004F;
  const auto crossings = estimator::rope_crossings(ropes, frame);
  ASSERT_EQ(crossings.size(), 1U);
  EXPECT_EQ(crossings[0].over, 0);
  EXPECT_EQ(crossings[0].under, 1);
  EXPECT_NEAR(crossings[0].over_at_m, 0.2F, 0.02F);
}

TEST(RopeCrossings, OfARingAreThoseThatShow) {
  std::vector<Estimate> ropes(2);
  ropes[0].closed = true;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const float turn = 6.2831853F * static_cast<float>(i) / kNodes;
    ropes[0].nodes[i] = {0.1F * std::cos(turn), 0.1F * std::sin(turn), 0.5F};
    const float along = -0.2F + 0.4F * static_cast<float>(i) / (kNodes - 1);
    ropes[1].nodes[i] = {along, along / 90, 0.45F};  // once through the gap of the last node
  }
  std::vector<std::uint8_t> mask(640 * 480, 0);
  std::fill_n(mask.begin(), 6400, std::uint8_t{255});
  const Frame frame{640, 480, {600, 600, 320, 240}, {}, mask, {}};
  const auto crossings = estimator::rope_crossings(ropes, frame);
  ASSERT_EQ(crossings.size(), 2U);
  for (const RopeCrossing& crossing : crossings) EXPECT_EQ(crossing.over, 1);
}

}  // namespace
}  // namespace flowdlo
