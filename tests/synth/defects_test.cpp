// What a Meta says about a frame's defects can be seen in the frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "synth/synthetic_frame.hpp"

namespace flowdlo::synth {
namespace {

constexpr std::uint64_t kScenes = 150;

const std::vector<SyntheticFrame>& scenes() {
  static const std::vector<SyntheticFrame> all = [] {
    std::vector<SyntheticFrame> frames;
    for (std::uint64_t i = 0; i < kScenes; ++i) {
      auto frame = make_frame(Split::kWide, Part::kTraining, 0, i, {.color = false});
      if (frame) frames.push_back(std::move(*frame));
    }
    return frames;
  }();
  return all;
}

TEST(Defects, EachOccursAndEachIsAbsentSomewhere) {
  const std::map<std::string, std::function<bool(const Defects&)>> flags = {
      {"gap", [](const Defects& d) { return d.gap; }},
      {"hidden_end", [](const Defects& d) { return d.hidden_end; }},
      {"outside", [](const Defects& d) { return d.outside; }},
      {"touch", [](const Defects& d) { return d.touch; }},
      {"coil", [](const Defects& d) { return d.coil; }},
      {"depth_holes", [](const Defects& d) { return d.depth_holes; }},
      {"depth_turn", [](const Defects& d) { return d.depth_turn; }},
      {"black_or_shiny", [](const Defects& d) { return d.black_or_shiny; }},
      {"depth_noise", [](const Defects& d) { return d.depth_noise; }},
      {"flying_pixels", [](const Defects& d) { return d.flying_pixels; }},
      {"edge_dropout", [](const Defects& d) { return d.edge_dropout; }},
      {"mask_ragged", [](const Defects& d) { return d.mask_ragged; }},
      {"mask_specks", [](const Defects& d) { return d.mask_specks; }},
      {"mask_gaps", [](const Defects& d) { return d.mask_gaps; }},
      {"mask_shifted", [](const Defects& d) { return d.mask_shifted; }},
      {"bars", [](const Defects& d) { return d.bars; }},
      {"hand", [](const Defects& d) { return d.hand; }},
      {"clutter", [](const Defects& d) { return d.clutter; }}};
  ASSERT_EQ(scenes().size(), kScenes);
  for (const auto& [name, flag] : flags) {
    const auto count = std::count_if(scenes().begin(), scenes().end(),
                                     [&f = flag](const auto& s) { return f(s.meta.defects); });
    EXPECT_GT(count, 0) << name;
    EXPECT_LT(count, static_cast<std::ptrdiff_t>(kScenes)) << name;
  }
}

TEST(Defects, EveryScenarioOccurs) {
  std::map<std::string, int> counts;
  for (const auto& scene : scenes()) ++counts[scene.meta.scenario];
  EXPECT_EQ(counts.size(), scenarios(Split::kWide).size());
}

TEST(Defects, BothEasyAndHardScenesAreCommonEnoughToBeCompared) {
  int easy = 0;
  int hard = 0;
  for (const auto& scene : scenes()) {
    easy += scene.meta.easy() ? 1 : 0;
    hard += scene.meta.hard() ? 1 : 0;
    EXPECT_FALSE(scene.meta.easy() && scene.meta.hard());
  }
  EXPECT_GE(easy, 15);
  EXPECT_GE(hard, 45);
}

// Nodes whose pixel, and those around it, satisfy nothing of `present`.
template <class Present>
int bare_nodes(const SyntheticFrame& frame, Present present) {
  const FrameFolder& folder = frame.folder;
  int bare = 0;
  for (const Point3& node : frame.truth()) {
    const auto u = std::lround(folder.intrinsics.fx * node.x / node.z + folder.intrinsics.cx);
    const auto v = std::lround(folder.intrinsics.fy * node.y / node.z + folder.intrinsics.cy);
    if (u < 0 || v < 0 || u >= folder.width || v >= folder.height) continue;
    bare += present(static_cast<std::size_t>(v * folder.width + u)) ? 0 : 1;
  }
  return bare;
}

TEST(Defects, AGapLeavesNodesWithoutMask) {
  for (const auto& scene : scenes()) {
    const double spacing = scene.meta.length_m / (kNodes - 1);
    const Defects& defects = scene.meta.defects;
    if (!defects.gap || defects.hidden_end || defects.outside) continue;
    if (scene.meta.longest_gap_m < 2.5 * spacing) continue;
    EXPECT_GE(bare_nodes(scene, [&](std::size_t p) { return scene.folder.mask[p] > 127; }), 1)
        << scene.folder.name;
  }
}

TEST(Defects, AHoleLeavesMaskedNodesWithoutDepth) {
  int seen = 0;
  for (const auto& scene : scenes()) {
    const double spacing = scene.meta.length_m / (kNodes - 1);
    if (scene.meta.longest_hole_m < 4 * spacing) continue;
    ++seen;
    EXPECT_TRUE(scene.meta.defects.depth_holes);
    EXPECT_GE(bare_nodes(scene,
                         [&](std::size_t p) {
                           return scene.folder.mask[p] <= 127 || scene.folder.depth_m[p] > 0;
                         }),
              1)
        << scene.folder.name;
  }
  EXPECT_GE(seen, 3);
}

TEST(Defects, OccludersAreCountedWhereTheyAreSeen) {
  for (const auto& scene : scenes()) {
    const Defects& defects = scene.meta.defects;
    EXPECT_EQ(scene.meta.occluders > 0, defects.bars || defects.hand) << scene.folder.name;
  }
}

TEST(Defects, CleanScenesHaveTheirWholeMask) {
  for (const auto& scene : scenes()) {
    const Defects& d = scene.meta.defects;
    if (!scene.meta.easy() || d.mask_ragged || d.mask_shifted) continue;
    EXPECT_GE(scene.meta.depth_share, 0.8);
    EXPECT_GE(scene.meta.visible_share, 0.8) << scene.folder.name;
  }
}

}  // namespace
}  // namespace flowdlo::synth
