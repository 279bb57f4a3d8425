#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <iterator>
#include <limits>

#include "flowdlo/frame_folder.hpp"
#include "frame/temporary_folder.hpp"

namespace flowdlo {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using testing::HasSubstr;

/// 4 x 3 px, depth 0.5 m in steps of 0.1 mm.
FrameFolder small_frame() {
  FrameFolder frame{"small", 4, 3, {100.5F, 101.25F, 2.0F, 1.5F}, {}, {}, {}, std::nullopt};
  for (int i = 0; i < 12; ++i) {
    frame.depth_m.push_back(0.5F + 0.0001F * static_cast<float>(i));
    frame.mask.push_back(i % 2 == 0 ? 255 : 0);
  }
  for (std::uint8_t i = 0; i < 36; ++i) frame.color_bgr.push_back(i);
  return frame;
}

TEST(FrameFolderWriter, WhatIsSavedLoadsBack) {
  const TemporaryFolder parent;
  const auto saved = small_frame();
  Centerline truth{};
  truth[63] = {0.1F, 0.2F, 0.3F};
  ASSERT_TRUE(save_frame_folder(parent.path() / "a" / "small", saved.frame(), 0.0001, &truth));
  const auto loaded = load_frame_folder(parent.path() / "a" / "small");
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->mask, saved.mask);
  EXPECT_EQ(loaded->color_bgr, saved.color_bgr);
  EXPECT_EQ(loaded->intrinsics.fy, saved.intrinsics.fy);
  ASSERT_TRUE(loaded->truth);
  EXPECT_EQ((*loaded->truth)[63], truth[63]);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_NEAR(loaded->depth_m[i], saved.depth_m[i], 1e-6F);
}

TEST(FrameFolderWriter, DepthIsRoundedToTheNearestStep) {
  const TemporaryFolder parent;
  auto saved = small_frame();
  saved.depth_m[0] = 0.5006F;
  saved.depth_m[1] = 0.5004F;
  ASSERT_TRUE(save_frame_folder(parent.path(), saved.frame(), 0.001));
  const auto loaded = load_frame_folder(parent.path());
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_FLOAT_EQ(loaded->depth_m[0], 0.501F);
  EXPECT_FLOAT_EQ(loaded->depth_m[1], 0.500F);
}

TEST(FrameFolderWriter, DepthThatIsNoneBecomesZero) {
  const TemporaryFolder parent;
  auto saved = small_frame();
  saved.depth_m[0] = std::numeric_limits<float>::quiet_NaN();
  saved.depth_m[1] = -1.0F;
  saved.depth_m[2] = std::numeric_limits<float>::infinity();
  ASSERT_TRUE(save_frame_folder(parent.path(), saved.frame(), 0.001));
  const auto loaded = load_frame_folder(parent.path());
  ASSERT_TRUE(loaded) << loaded.error().message;
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(loaded->depth_m[i], 0.0F);
}

TEST(FrameFolderWriter, DepthBeyondTheLastStepIsAnErrorAndLeavesNoFile) {
  const TemporaryFolder parent;
  auto saved = small_frame();
  saved.depth_m[5] = 70.0F;
  const auto done = save_frame_folder(parent.path(), saved.frame(), 0.001);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(done.error().message, HasSubstr("expected at most 65.535 m"));
  EXPECT_TRUE(fs::is_empty(parent.path()));
}

TEST(FrameFolderWriter, UnusableDepthScaleIsAnError) {
  const TemporaryFolder parent;
  for (const double scale : {0.0, -0.001, 1000.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(save_frame_folder(parent.path(), small_frame().frame(), scale));
  }
}

TEST(FrameFolderWriter, InvalidFrameIsAnError) {
  const TemporaryFolder parent;
  auto saved = small_frame();
  saved.mask.pop_back();
  EXPECT_FALSE(save_frame_folder(parent.path() / "b", saved.frame(), 0.001));
  EXPECT_FALSE(fs::exists(parent.path() / "b"));
}

TEST(FrameFolderWriter, NothingOfAnEarlierFrameStays) {
  const TemporaryFolder parent;
  const Centerline truth{};
  auto saved = small_frame();
  ASSERT_TRUE(save_frame_folder(parent.path(), saved.frame(), 0.001, &truth));
  saved.color_bgr.clear();
  ASSERT_TRUE(save_frame_folder(parent.path(), saved.frame(), 0.001));
  EXPECT_FALSE(fs::exists(parent.path() / "color.png"));
  EXPECT_FALSE(fs::exists(parent.path() / "truth.csv"));
  EXPECT_EQ(std::distance(fs::directory_iterator(parent.path()), fs::directory_iterator()), 3);
}

TEST(FrameFolderWriter, FileInPlaceOfTheFolderIsAnIoError) {
  const TemporaryFolder parent;
  test::write_text(parent.path() / "file", "x");
  const auto done = save_frame_folder(parent.path() / "file", small_frame().frame(), 0.001);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace flowdlo
