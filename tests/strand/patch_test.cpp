#include "strand/patch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "frame/temporary_folder.hpp"
#include "strand/patch_store.hpp"

namespace flowdlo::strand {
namespace {

constexpr std::uint64_t kSeed = 3;

TEST(Patch, IsTheSameEveryTimeAndAnotherForAnotherScene) {
  const auto first = patches_of(synth::Split::kWide, synth::Part::kTraining, kSeed, 5);
  const auto again = patches_of(synth::Split::kWide, synth::Part::kTraining, kSeed, 5);
  const auto other = patches_of(synth::Split::kWide, synth::Part::kTraining, kSeed, 6);
  ASSERT_TRUE(first && again && other);
  ASSERT_FALSE(first->empty());
  ASSERT_EQ(first->size(), again->size());
  EXPECT_EQ(first->front().color_bgr, again->front().color_bgr);
  EXPECT_EQ(first->front().depth, again->front().depth);
  EXPECT_NE(first->front().mask, other->front().mask);
}

/// Visible points of the strands within their patches, and how many of them the mask shows.
struct OnMask {
  int visible = 0;
  int masked = 0;
};

OnMask on_mask(const std::vector<Patch>& patches) {
  OnMask count;
  for (const Patch& patch : patches) {
    for (const Strand& strand : patch.strands) {
      for (const AxisPoint& point : strand.points) {
        const auto u = static_cast<int>(std::lround(point.u));
        const auto v = static_cast<int>(std::lround(point.v));
        if (point.seen != Seen::kYes || u < 0 || v < 0 || u >= patch.width || v >= patch.height) {
          continue;
        }
        ++count.visible;
        count.masked += patch.mask[static_cast<std::size_t>(v * patch.width + u)] > 60;
      }
    }
  }
  return count;
}

TEST(Patch, ItsStrandsLieOnTheRopeThatItShows) {
  const auto patches = patches_of(synth::Split::kWide, synth::Part::kTraining, kSeed, 11);
  ASSERT_TRUE(patches);
  const OnMask count = on_mask(*patches);
  EXPECT_GT(count.visible, 100);
  EXPECT_GT(count.masked, 0.9 * count.visible);
}

/// A frame of which every strand is known; its picture is not.
Result<synth::SyntheticFrame> dense_frame(std::uint64_t index) {
  synth::Render render;
  render.color = false;
  render.dense = true;
  return synth::make_frame(synth::Split::kWide, synth::Part::kTraining, kSeed, index, render);
}

TEST(Patch, AnEndThatAGripperHoldsIsWhereItIsSeenLast) {
  int held = 0;
  for (std::uint64_t index = 0; index < 80 && held < 3; ++index) {
    const auto scenario =
        synth::scenario_of(synth::Split::kWide, synth::Part::kTraining, kSeed, index);
    ASSERT_TRUE(scenario);
    if (*scenario != "hanging") continue;
    const auto frame = dense_frame(index);
    ASSERT_TRUE(frame);
    const auto& curve = frame->dense->curves.front();
    const double width_m = 2 * frame->ropes.front().radius_m;
    const auto strands = strands_of(*frame);
    const auto& points = strands.front().points;
    const double before = static_cast<double>(points.front().along_widths);
    const double behind =
        curve.length_m() / width_m - static_cast<double>(points.back().along_widths);
    for (const auto& [off, end] :
         {std::pair(before, points.front()), std::pair(behind, points.back())}) {
      EXPECT_LE(off, 8.001);
      if (off < 0.01) continue;
      EXPECT_NE(end.seen, Seen::kNo) << index;
      ++held;
    }
  }
  EXPECT_GE(held, 3);
}

TEST(Patch, OfDrawnFramesShowsOneRopeAndSeveralByTurns) {
  for (std::uint64_t index = 0; index < 8; ++index) {
    const auto patches = drawn_patches_of(kSeed, index);
    ASSERT_FALSE(patches.empty());
    const OnMask count = on_mask(patches);
    EXPECT_GT(count.masked, 0.9 * count.visible) << index;
    int ropes = 0;
    for (const Patch& patch : patches) {
      for (const Strand& strand : patch.strands) ropes = std::max(ropes, strand.rope + 1);
    }
    if (index % 2 == 0) {
      EXPECT_EQ(ropes, 1) << index;
    } else {
      EXPECT_GE(ropes, 2) << index;
    }
  }
  EXPECT_EQ(drawn_patches_of(kSeed, 3).front().mask, drawn_patches_of(kSeed, 3).front().mask);
}

TEST(Patch, AWideRopeIsShrunk) {
  PatchConfig config;
  config.most_rope_px = 4;
  for (std::uint64_t index = 0; index < 4; ++index) {
    const auto patches =
        patches_of(synth::Split::kWide, synth::Part::kTraining, kSeed, index, config);
    ASSERT_TRUE(patches);
    for (const Patch& patch : *patches) EXPECT_LE(patch.rope_px, 4.001F);
  }
}

class PatchStoreTest : public ::testing::Test {
 protected:
  void make(std::uint64_t scenes) {
    const auto made = make_patches(folder_.path(),
                                   {.seed = kSeed,
                                    .scenes = scenes,
                                    .several = several_,
                                    .touching = touching_,
                                    .matched = matched_,
                                    .patch = small_},
                                   2, [] {});
    ASSERT_TRUE(made) << made.error().message;
  }
  [[nodiscard]] std::filesystem::path first_shard() const {
    return folder_.path() / "patches_00000.bin";
  }

  PatchConfig small_{.each = 1, .half_widths = 4, .least_half_px = 12};
  double several_ = 0;
  double touching_ = 0;
  double matched_ = 0;
  test::TemporaryFolder folder_;
};

TEST_F(PatchStoreTest, GivesBackWhatWasMade) {
  make(1);  // rounded up to a shard
  const auto store = PatchStore::open(folder_.path());
  ASSERT_TRUE(store) << store.error().message;
  ASSERT_GT(store->size(), 30U);
  const auto stored = store->read(0);
  const auto made = patches_of(synth::Split::kWide, synth::Part::kTraining, kSeed, 0, small_);
  ASSERT_TRUE(stored && made);
  EXPECT_EQ(stored->color_bgr, made->front().color_bgr);
  EXPECT_EQ(stored->depth, made->front().depth);
  ASSERT_EQ(stored->strands.size(), made->front().strands.size());
  EXPECT_EQ(stored->strands[0].points.size(), made->front().strands[0].points.size());
}

TEST_F(PatchStoreTest, AShareOfTheScenesShowsSeveralRopes) {
  several_ = 0.5;
  make(1);
  const auto store = PatchStore::open(folder_.path());
  ASSERT_TRUE(store) << store.error().message;
  int several = 0;
  for (std::size_t i = 0; i < store->size(); ++i) {
    const auto patch = store->read(i);
    ASSERT_TRUE(patch);
    several += std::any_of(patch->strands.begin(), patch->strands.end(),
                           [](const Strand& strand) { return strand.rope > 0; });
  }
  EXPECT_GT(several, 10);
  EXPECT_LT(several, 30);
}

TEST_F(PatchStoreTest, AShareOfTheScenesShowsARingWhoseEndsTouch) {
  small_ = {.each = 2, .near_share = 0, .end_share = 1};
  touching_ = 0.5;
  make(1);
  const auto store = PatchStore::open(folder_.path());
  ASSERT_TRUE(store) << store.error().message;
  int both = 0;  // patches that show both ends
  for (std::size_t i = 0; i < store->size(); ++i) {
    const auto patch = store->read(i);
    ASSERT_TRUE(patch);
    const auto shows = [&](bool Strand::*end) {
      return std::any_of(patch->strands.begin(), patch->strands.end(),
                         [&](const Strand& strand) { return strand.*end; });
    };
    both += shows(&Strand::begins) && shows(&Strand::ends);
  }
  EXPECT_GT(both, 25) << "of 64 patches, half of them of such rings";
}

TEST_F(PatchStoreTest, AShareOfTheScenesHasMatchedDepth) {
  small_.each = 2;
  matched_ = 0.2;
  make(1);
  const auto store = PatchStore::open(folder_.path());
  ASSERT_TRUE(store) << store.error().message;
  std::size_t at = 0;
  int others = 0;
  for (std::uint64_t scene = 0; scene < kShardScenes && at < store->size(); ++scene) {
    const auto modelled =
        patches_of(synth::Split::kWide, synth::Part::kTraining, kSeed, scene, small_);
    ASSERT_TRUE(modelled);
    for (const Patch& patch : *modelled) {
      const auto stored = store->read(at++);
      ASSERT_TRUE(stored);
      EXPECT_EQ(stored->mask, patch.mask) << "depth alone is another";
      if (stored->depth == patch.depth) continue;
      EXPECT_EQ(scene % 5, 4U) << "every fifth scene";
      ++others;
    }
  }
  EXPECT_GT(others, 4) << "more than half of all scenes are seen by a stereo camera";
}

TEST_F(PatchStoreTest, AnEmptyFolderIsAnError) {
  const auto store = PatchStore::open(folder_.path());
  ASSERT_FALSE(store);
  EXPECT_EQ(store.error().code, ErrorCode::kBadInput);
}

TEST_F(PatchStoreTest, ADamagedShardIsRefused) {
  make(1);
  std::filesystem::resize_file(first_shard(), std::filesystem::file_size(first_shard()) - 1);
  EXPECT_FALSE(PatchStore::open(folder_.path()));
  std::ofstream(first_shard(), std::ios::binary) << "no patches at all";
  EXPECT_FALSE(PatchStore::open(folder_.path()));
}

}  // namespace
}  // namespace flowdlo::strand
