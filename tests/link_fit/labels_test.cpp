#include "link_fit/labels.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "link_fit/sample.hpp"
#include "strand/scene_range.hpp"
#include "synth/drawn_frame.hpp"

namespace flowdlo::lab {
namespace {

std::unique_ptr<const Labelled> labelled(synth::SyntheticFrame scene, bool several) {
  auto network = strand::one_network(FLOWDLO_FIELD_WEIGHTS);
  EXPECT_TRUE(network);
  auto result = label(std::move(scene), several, *network);
  EXPECT_TRUE(result) << result.error().message;
  return result ? *std::move(result) : nullptr;
}

void expect_mutual(const std::vector<int>& partners) {
  for (int end = 0; end < static_cast<int>(partners.size()); ++end) {
    const int partner = partners[static_cast<std::size_t>(end)];
    if (partner < 0) continue;
    EXPECT_NE(partner, end);
    EXPECT_EQ(partners[static_cast<std::size_t>(partner)], end);
  }
}

TEST(Labels, OfOneRopeThatCrossesItselfTwoEndsAreItsOwn) {
  const auto of = labelled(synth::drawn_frame(Kind::kOneCrossing, 5, true), false);
  ASSERT_TRUE(of);
  expect_mutual(of->partners);
  EXPECT_EQ(std::count(of->partners.begin(), of->partners.end(), kStops), 2);
  EXPECT_EQ(std::count(of->partners.begin(), of->partners.end(), kUnknown), 0);
  // The rope's own ends are where it stops.
  const auto& curve = of->scene.truth();
  for (std::size_t end = 0; end < of->partners.size(); ++end) {
    if (of->partners[end] != kStops) continue;
    const Eigen::Vector2f place =
        of->strands.end(static_cast<int>(end)).point_px + path::offset_of(of->region);
    float nearest = 1e9F;
    for (const auto& node : {curve.front(), curve.back()}) {
      const auto& camera = of->frame.intrinsics;
      const Eigen::Vector2f seen(camera.fx * node.x / node.z + camera.cx,
                                 camera.fy * node.y / node.z + camera.cy);
      nearest = std::min(nearest, (seen - place).norm());
    }
    EXPECT_LT(nearest, 2 * of->strands.width_px);
  }
}

TEST(Labels, ARingEndsNowhere) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    auto scene = synth::drawn_ropes_frame(RopesKind::kRings, 2, seed, true);
    const auto rings = std::count_if(scene.ropes.begin(), scene.ropes.end(),
                                     [](const synth::TrueRope& rope) { return rope.closed; });
    ASSERT_EQ(rings, 1);
    const auto of = labelled(std::move(scene), true);
    ASSERT_TRUE(of);
    expect_mutual(of->partners);
    const auto stops = std::count(of->partners.begin(), of->partners.end(), kStops);
    const bool whole = std::any_of(of->strands.list.begin(), of->strands.list.end(),
                                   [](const path::Strand& strand) { return strand.ring; });
    EXPECT_TRUE(whole || stops == 2) << "those of the other rope, not " << stops;
  }
}

TEST(Labels, SamplesHoldTheRightLinksAndWhatTheEngineAsksAbout) {
  const auto of = labelled(synth::drawn_ropes_frame(RopesKind::kCrossing, 3, 4, true), true);
  ASSERT_TRUE(of);
  const LinkSample sample = sample_of(*of);
  ASSERT_EQ(sample.ends.size(), of->partners.size());
  std::size_t right = 0;
  for (const auto& link : sample.links) {
    EXPECT_LT(link.a, link.b);
    right += sample.ends[static_cast<std::size_t>(link.a)].partner == link.b ? 1 : 0;
    EXPECT_EQ(link.forth[0], 1);
    EXPECT_EQ(link.forth[1], 0) << "it is no stop";
  }
  const auto linked = std::count_if(of->partners.begin(), of->partners.end(),
                                    [](int partner) { return partner >= 0; });
  EXPECT_GT(linked, 0);
  EXPECT_EQ(2 * right, static_cast<std::size_t>(linked));
  EXPECT_GT(sample.links.size(), right) << "and others";
  EXPECT_EQ(sample.ends.front().features[1], 1);
}

}  // namespace
}  // namespace flowdlo::lab
