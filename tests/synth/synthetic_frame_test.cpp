#include "synth/synthetic_frame.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "flowdlo/frame.hpp"

namespace flowdlo::synth {
namespace {

using testing::HasSubstr;

SyntheticFrame frame_of(Split split, Part part, std::uint64_t seed, std::uint64_t index,
                        const Render& render = {.color = false}) {
  auto frame = make_frame(split, part, seed, index, render);
  EXPECT_TRUE(frame) << frame.error().message;
  return frame ? std::move(*frame) : SyntheticFrame{};
}

void expect_same(const SyntheticFrame& a, const SyntheticFrame& b) {
  EXPECT_EQ(a.folder.depth_m, b.folder.depth_m);
  EXPECT_EQ(a.folder.mask, b.folder.mask);
  EXPECT_EQ(a.truth(), b.truth());
  EXPECT_EQ(meta_json(a.meta), meta_json(b.meta));
}

TEST(MakeFrame, IsAPureFunction) {
  for (const std::uint64_t index : {0ULL, 7ULL, 15ULL}) {
    const auto first = frame_of(Split::kWide, Part::kTraining, 3, index, {.color = true});
    const auto second = frame_of(Split::kWide, Part::kTraining, 3, index, {.color = true});
    expect_same(first, second);
    EXPECT_EQ(first.folder.color_bgr, second.folder.color_bgr);
  }
}

TEST(MakeFrame, GivesTheSameOnManyThreads) {
  constexpr std::uint64_t kScenes = 6;
  std::vector<SyntheticFrame> alone(kScenes);
  std::vector<SyntheticFrame> together(kScenes);
  for (std::uint64_t i = 0; i < kScenes; ++i) {
    alone[i] = frame_of(Split::kWide, Part::kValidation, 0, i);
  }
  std::vector<std::thread> threads;
  for (std::uint64_t i = 0; i < kScenes; ++i) {
    threads.emplace_back(
        [&together, i] { together[i] = frame_of(Split::kWide, Part::kValidation, 0, i); });
  }
  for (auto& thread : threads) thread.join();
  for (std::uint64_t i = 0; i < kScenes; ++i) expect_same(alone[i], together[i]);
}

TEST(MakeFrame, ColourChangesNothingElse) {
  const auto with = frame_of(Split::kWide, Part::kTraining, 0, 4, {.color = true});
  const auto without = frame_of(Split::kWide, Part::kTraining, 0, 4, {.color = false});
  EXPECT_FALSE(with.folder.color_bgr.empty());
  EXPECT_TRUE(without.folder.color_bgr.empty());
  expect_same(with, without);
}

TEST(MakeFrame, EveryFrameIsValid) {
  for (std::uint64_t index = 0; index < 40; ++index) {
    const auto frame = frame_of(Split::kWide, Part::kTraining, 0, index, {.color = index % 8 == 0});
    const auto valid = validate(frame.frame());
    EXPECT_TRUE(valid) << valid.error().message;
  }
}

TEST(MakeFrame, PartsShareNoScene) {
  std::set<std::vector<float>> truths;
  for (const std::uint64_t seed : {0ULL, 1ULL}) {
    for (const Part part : {Part::kTraining, Part::kValidation}) {
      for (std::uint64_t index = 0; index < 12; ++index) {
        std::vector<float> flat;
        const auto frame = frame_of(Split::kThesis, part, seed, index);
        for (const Point3& node : frame.truth()) {
          flat.insert(flat.end(), {node.x, node.y, node.z});
        }
        EXPECT_TRUE(truths.insert(flat).second);
      }
    }
  }
}

TEST(MakeFrame, FramesOfASceneShareItsTruthAndDifferInTheirNoise) {
  const auto zero = frame_of(Split::kWide, Part::kTraining, 0, 9, {.color = true, .frame = 0});
  const auto one = frame_of(Split::kWide, Part::kTraining, 0, 9, {.color = true, .frame = 1});
  EXPECT_EQ(zero.truth(), one.truth());
  EXPECT_EQ(zero.meta.scenario, one.meta.scenario);
  EXPECT_NE(zero.folder.depth_m, one.folder.depth_m);
  EXPECT_NE(zero.folder.color_bgr, one.folder.color_bgr);
  EXPECT_NE(zero.folder.name, one.folder.name);
}

TEST(MakeFrame, BadArgumentsAreAllNamed) {
  const auto beyond =
      make_frame(Split::kThesis, Part::kValidation, 0, 59, {.color = false, .frame = -1});
  ASSERT_FALSE(beyond);
  EXPECT_EQ(beyond.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(beyond.error().message, HasSubstr("index: expected below 59 (thesis validation)"));
  EXPECT_THAT(beyond.error().message, HasSubstr("frame: expected 0 or more, got -1"));
}

std::map<std::string, int> groups(Part part) {
  std::map<std::string, int> counts;
  for (std::uint64_t i = 0; i < scene_count(Split::kThesis, part); ++i) {
    const auto name = scenario_of(Split::kThesis, part, 0, i);
    EXPECT_TRUE(name);
    if (name) ++counts[std::string(*name)];
  }
  return counts;
}

TEST(ThesisSplit, HasTheGroupsOfSection411) {
  EXPECT_EQ(scene_count(Split::kThesis, Part::kTraining), 234U);
  EXPECT_EQ(scene_count(Split::kThesis, Part::kValidation), 59U);
  const std::map<std::string, int> validation = {{"C", 6},
                                                 {"S", 6},
                                                 {"straight", 2},
                                                 {"intersection", 8},
                                                 {"C-complicated", 7},
                                                 {"S-complicated", 8},
                                                 {"straight-complicated", 2},
                                                 {"intersection-complicated", 8},
                                                 {"intersection-new", 12}};
  EXPECT_EQ(groups(Part::kValidation), validation);
  EXPECT_EQ(groups(Part::kTraining).size(), 9U);
}

TEST(ThesisSplit, IsATableFromNearWithCleanDepth) {
  for (std::uint64_t i = 0; i < 59; ++i) {
    const auto frame = frame_of(Split::kThesis, Part::kValidation, 0, i);
    const Meta& meta = frame.meta;
    EXPECT_GE(meta.distance_m, 0.3);
    EXPECT_LE(meta.distance_m, 0.5);
    EXPECT_FALSE(meta.hanging);
    EXPECT_EQ(meta.occluders, 0);
    EXPECT_DOUBLE_EQ(meta.depth_share, 1.0);
    EXPECT_FALSE(meta.defects.depth_noise);
    const bool named_intersection = meta.scenario.starts_with("intersection");
    EXPECT_EQ(meta.intersection, named_intersection) << frame.folder.name;
  }
}

TEST(ThesisSplit, RopeHasItsMaterialsColour) {
  for (std::uint64_t i = 0; i < 59; i += 6) {
    const auto frame = frame_of(Split::kThesis, Part::kValidation, 0, i, {.color = true});
    const FrameFolder& folder = frame.folder;
    const bool gray = frame.meta.material == "dark-gray";
    double blue = 0;
    double green = 0;
    double red = 0;
    for (std::size_t p = 0; p < folder.mask.size(); ++p) {
      if (folder.mask[p] <= 127) continue;
      blue += folder.color_bgr[3 * p];
      green += folder.color_bgr[3 * p + 1];
      red += folder.color_bgr[3 * p + 2];
    }
    const double most = std::max({blue, green, red});
    const double least = std::min({blue, green, red});
    EXPECT_EQ(least > 0.75 * most, gray) << frame.meta.material;
    if (frame.meta.material == "blue") {
      EXPECT_EQ(most, blue);
    }
    if (frame.meta.material == "red") {
      EXPECT_EQ(most, red);
    }
    if (frame.meta.material == "green") {
      EXPECT_EQ(most, green);
    }
    if (frame.meta.material == "cyan-green") {
      EXPECT_EQ(least, red);
    }
  }
}

TEST(WideSplit, StaysWithinItsLimits) {
  std::set<std::string> cameras;
  std::set<std::string> materials;
  for (std::uint64_t i = 0; i < 80; ++i) {
    const Meta meta = frame_of(Split::kWide, Part::kValidation, 0, i).meta;
    EXPECT_GE(meta.distance_m, 0.25);
    EXPECT_LE(meta.distance_m, 1.5);
    EXPECT_GE(meta.tilt_deg, 0);
    EXPECT_LE(meta.tilt_deg, 70.001);
    EXPECT_GE(meta.radius_m, 0.0008);
    EXPECT_LE(meta.radius_m, 0.012);
    EXPECT_GE(meta.length_m, 0.2);
    EXPECT_LE(meta.length_m, 2.0);
    EXPECT_GE(meta.width_px, 2.0);
    EXPECT_GE(meta.visible_share, 0.4);
    cameras.insert(meta.camera);
    materials.insert(meta.material);
  }
  EXPECT_GE(cameras.size(), 8U);
  EXPECT_EQ(materials.size(), 5U);
}

}  // namespace
}  // namespace flowdlo::synth
