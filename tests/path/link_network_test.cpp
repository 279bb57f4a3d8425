#include "path/link_network.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "path/links.hpp"
#include "path/strand_reading.hpp"
#include "seen.hpp"

namespace flowdlo::path {
namespace {

using testing::straight_axis;

/// One that says the same of everything, and what it is told alone.
weights::LinkWeights with(float always, std::size_t feature = 0, float weight = 0) {
  weights::LinkWeights links = weights::seeded_links(1);
  for (auto& tensor : links.tensors) std::fill(tensor.values.begin(), tensor.values.end(), 0.0F);
  links.tensors.back().values[0] += always;
  links.tensors.back().values[feature] += weight;
  return links;
}

LinkSide side(float tip, float turn) {
  LinkSide side{};
  side.end[kEndTip] = tip;
  side.side[kSideTurn] = turn;
  return side;
}

TEST(LinkNetwork, SaysNegativeLogarithmsOfLikelihoods) {
  const auto even = with(0);
  EXPECT_FLOAT_EQ(LinkNetwork(even).stop({}), std::log(2.0F));
  const auto sure = with(-30);
  EXPECT_NEAR(LinkNetwork(sure).stop({}), 0, 1e-6F);
  EXPECT_GE(LinkNetwork(sure).link({}, side(1, 0.5F), side(0, 0)), 0);
  const auto never = with(200);
  EXPECT_FLOAT_EQ(LinkNetwork(never).stop({}), 200) << "and no infinity";
}

TEST(LinkNetwork, IsStraightAndBent) {
  auto links = with(0.25F);
  links.tensors[0].values[static_cast<std::size_t>(weights::kLinkInputs) * 3] = 0.5F;  // of 1
  links.tensors[1].values[3] = 2;
  const float against = 0.25F + 2 * std::tanh(0.5F);
  EXPECT_NEAR(LinkNetwork(links).stop({}), std::log1p(std::exp(against)), 1e-5F);
}

TEST(LinkNetwork, ALinkCostsTheSameFromBothEnds) {
  const auto links = weights::seeded_links(5);
  const LinkNetwork network(links);
  PairFeatures pair{};
  pair[kPairChord] = 1.5F;
  const LinkSide a = side(0.9F, 0.2F);
  const LinkSide b = side(0.1F, 0.6F);
  EXPECT_EQ(network.link(pair, a, b), network.link(pair, b, a));
  EXPECT_NE(network.link(pair, a, b), network.link(pair, a, a));
}

TEST(LinkNetwork, KnowsAStopFromALink) {
  const auto links = with(0, 1, 3);  // the second feature is 1 where nothing follows
  const LinkNetwork network(links);
  EXPECT_GT(network.stop({}), network.link({}, {}, {}) + 2);
}

/// Two strands with a gap of two widths, then one that comes from the side.
struct Gapped : test::Seen {
  Gapped()
      : Seen({straight_axis({40, 120}, {150, 120}), straight_axis({166, 120}, {280, 120}),
              straight_axis({158, 200}, {158, 140})}) {}

  [[nodiscard]] Prices prices(std::shared_ptr<const weights::LinkWeights> links,
                              bool several = false) {
    const Frame frame = canvas.frame();
    field.links = std::move(links);
    const field::Axes axes = field::axes(field);
    const auto region = clean(frame);
    EXPECT_TRUE(region);
    return prices_of(strands_of(frame, axes, *region, several), *region, frame);
  }
};

TEST(LinkNetwork, PricesWhatTheEnergyChooses) {
  Gapped gapped;
  const Prices by_energy = gapped.prices(nullptr);
  const Prices by_network =
      gapped.prices(std::make_shared<const weights::LinkWeights>(with(0, 2 + kPairChord, 1)));
  ASSERT_EQ(by_network.bonds.size(), by_energy.bonds.size());
  ASSERT_FALSE(by_energy.bonds[0].empty());
  for (std::size_t end = 0; end < by_energy.bonds.size(); ++end) {
    EXPECT_FLOAT_EQ(by_network.stops[end], std::log(2.0F));
    std::vector<int> asked;
    std::vector<int> answered;
    for (const Bond& bond : by_energy.bonds[end]) asked.push_back(bond.to);
    for (const Bond& bond : by_network.bonds[end]) answered.push_back(bond.to);
    EXPECT_TRUE(std::is_permutation(asked.begin(), asked.end(), answered.begin(), answered.end()));
    EXPECT_TRUE(std::is_sorted(by_network.bonds[end].begin(), by_network.bonds[end].end(),
                               [](const Bond& a, const Bond& b) { return a.cost < b.cost; }));
  }
}

TEST(LinkNetwork, OneMoreOfSeveralRopesCostsALittle) {
  Gapped gapped;
  const Prices prices = gapped.prices(std::make_shared<const weights::LinkWeights>(with(0)), true);
  for (const float stop : prices.stops) {
    EXPECT_FLOAT_EQ(2 * stop, 2 * std::log(2.0F) + kOneMoreEnergy);
  }
}

TEST(LinkEvidence, IsOfTheGapAndOfBothEnds) {
  Gapped gapped;
  const Frame frame = gapped.canvas.frame();
  const field::Axes axes = field::axes(gapped.field);
  const auto region = clean(frame);
  ASSERT_TRUE(region);
  const Strands strands = strands_of(frame, axes, *region);
  const Cover cover(*region, frame, strands.width_px, strands.seen);
  const auto end_near = [&](float u, float v) {
    int nearest = 0;
    const auto off = [&](int end) {
      return (strands.end(end).point_px + offset_of(*region) - Eigen::Vector2f(u, v)).norm();
    };
    for (int end = 1; end < static_cast<int>(2 * strands.list.size()); ++end) {
      if (off(end) < off(nearest)) nearest = end;
    }
    return nearest;
  };
  const int left = end_near(150, 120);
  const int right = end_near(166, 120);
  const int below = end_near(158, 140);
  ASSERT_NE(left, right);
  const auto pair = [&](int a, int b) {
    return pair_features(a, b, link_between(a, b, strands, cover, kOneRopeLinks), strands, cover);
  };
  const PairFeatures straight = pair(left, right);
  EXPECT_NEAR(straight[kPairChord], std::log1p(2.0F), 0.35F);
  EXPECT_LT(straight[kPairTurn], 0.05F);
  EXPECT_NEAR(pair(left, below)[kPairTurn], 0.5F, 0.1F);
  EXPECT_EQ(straight[kPairOwn], 0);
  EXPECT_EQ(pair(2 * (left / 2), 2 * (left / 2) + 1)[kPairOwn], 1);
  EXPECT_EQ(straight[kPairDeep], 1);
  EXPECT_LT(straight[kPairApart], 0.1F) << "both are as deep";
  const SideFeatures on = side_features(left, right, strands, cover);
  EXPECT_LT(on[kSideTurn], 0.05F);
  EXPECT_GT(on[kSideAhead], 0.8F);
  EXPECT_LT(on[kSideAside], 0.2F);
  const SideFeatures behind = side_features(left ^ 1, right, strands, cover);
  EXPECT_LT(behind[kSideAhead], 0) << "the far end looks the other way";
  EXPECT_GT(behind[kSideTurn], 0.9F);
  const EndFeatures end = end_features(left, strands, cover, 0.25F);
  EXPECT_EQ(end[kEndHeard], 0.25F);
  EXPECT_NEAR(end[kEndLength], std::log1p(110.0F / 8), 0.3F);
  EXPECT_EQ(end[kEndSeveral], 0);
}

}  // namespace
}  // namespace flowdlo::path
