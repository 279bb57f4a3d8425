// flowdlo mask, run as a user would run it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "flowdlo/frame_folder.hpp"
#include "frame/temporary_folder.hpp"
#include "support/source_dir.hpp"
#include "tools/program.hpp"

namespace flowdlo {
namespace {

namespace fs = std::filesystem;
using test::run_flowdlo;
using test::TemporaryFolder;
using ::testing::HasSubstr;

const std::vector<std::string> kRed = {"--color", "209,36,36"};

/// The frame that ships, without its mask.
fs::path frame_without_mask(const fs::path& parent, const std::string& name = "rope") {
  const fs::path folder = parent / name;
  fs::create_directories(folder);
  for (const char* file : {"camera.json", "color.png", "depth.png"}) {
    fs::copy_file(test::source_dir() / "examples/frames/overhand_loop" / file, folder / file);
  }
  return folder;
}

test::Outcome run_mask(const fs::path& scratch, std::vector<std::string> arguments,
                       const std::vector<std::string>& more = {}) {
  arguments.insert(arguments.begin(), "mask");
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_flowdlo(scratch, arguments);
}

double overlap_with_shipped(const std::vector<std::uint8_t>& mask) {
  const auto shipped = load_frame_folder(test::source_dir() / "examples/frames/overhand_loop");
  double common = 0;
  double all = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    common += mask[i] > 127 && shipped->mask[i] > 127 ? 1 : 0;
    all += mask[i] > 127 || shipped->mask[i] > 127 ? 1 : 0;
  }
  return common / all;
}

TEST(MaskCommand, CompletesAFolderSoThatItIsAFrame) {
  const TemporaryFolder scratch;
  for (const auto& way : {kRed, {"--table"}, {"--click", "280,222"}, {"--height", "0.002,0.05"}}) {
    const auto folder = frame_without_mask(scratch.path(), way[0].substr(2));
    ASSERT_FALSE(load_frame_folder(folder));
    const auto outcome = run_mask(scratch.path(), {folder.string()}, way);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const auto loaded = load_frame_folder(folder);
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_GT(overlap_with_shipped(loaded->mask), 0.8) << way[0];
    EXPECT_TRUE(fs::exists(folder / "mask_overlay.png"));
  }
}

TEST(MaskCommand, GivesWhatAllWaysHaveInCommon) {
  const TemporaryFolder scratch;
  const auto folder = frame_without_mask(scratch.path());
  const auto outcome =
      run_mask(scratch.path(), {folder.string(), "--table", "--click", "10,10"}, kRed);
  EXPECT_EQ(outcome.exit_code, 1);  // the click is on the table, the rest is the rope
  EXPECT_THAT(outcome.err, HasSubstr("no pixel fits"));
  EXPECT_FALSE(fs::exists(folder / "mask.png"));
}

TEST(MaskCommand, LeavesAMaskThatIsThereUnlessForced) {
  const TemporaryFolder scratch;
  const auto folder = frame_without_mask(scratch.path());
  test::write_text(folder / "mask.png", "mine");
  const auto refused = run_mask(scratch.path(), {folder.string()}, kRed);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("--force"));
  EXPECT_EQ(test::read_text(folder / "mask.png"), "mine");
  EXPECT_EQ(run_mask(scratch.path(), {folder.string(), "--force"}, kRed).exit_code, 0);
  EXPECT_TRUE(load_frame_folder(folder));
}

TEST(MaskCommand, TakesFoldersOfFramesAndPictures) {
  const TemporaryFolder scratch;
  frame_without_mask(scratch.path() / "set", "one");
  frame_without_mask(scratch.path() / "set", "two");
  const auto picture = scratch.path() / "photo.png";
  fs::copy_file(scratch.path() / "set/one/color.png", picture);
  const auto out = (scratch.path() / "out").string();
  const auto outcome = run_mask(
      scratch.path(), {(scratch.path() / "set").string(), picture.string(), "--out", out}, kRed);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* name : {"one", "two", "photo"}) {
    EXPECT_TRUE(fs::exists(scratch.path() / "out" / name / "mask.png")) << name;
    EXPECT_FALSE(fs::exists(scratch.path() / "set" / name / "mask.png")) << name;
  }
}

TEST(MaskCommand, GoesOnAfterAFrameThatHasNoMask) {
  const TemporaryFolder scratch;
  const auto good = frame_without_mask(scratch.path(), "good");
  const auto outcome =
      run_mask(scratch.path(), {(scratch.path() / "nowhere").string(), good.string()}, kRed);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("nowhere"));
  EXPECT_TRUE(fs::exists(good / "mask.png"));
}

TEST(MaskCommand, EndsWithTwoOnWrongUsage) {
  const TemporaryFolder scratch;
  const auto folder = frame_without_mask(scratch.path()).string();
  const auto picture = folder + "/color.png";
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {folder},                    // no way to the mask
           {picture, "--table"},        // no --out
           {folder, "--color", "1,2"},  // no colour
           {folder, "--color", "1,2,300"},
           {folder, "--click", "here"},
           {folder, "--height", "0.1"},
           {folder, folder, "--table", "--out", folder + "/out"},  // one name twice
           {"--table"}}) {
    const auto outcome = run_mask(scratch.path(), arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.out << outcome.err;
    EXPECT_NE(outcome.err, "");
  }
  EXPECT_FALSE(fs::exists(fs::path(folder) / "mask.png"));
}

TEST(MaskCommand, SaysThatAPictureHasNoDepth) {
  const TemporaryFolder scratch;
  const auto folder = frame_without_mask(scratch.path());
  const auto outcome = run_mask(scratch.path(), {(folder / "color.png").string(), "--table",
                                                 "--out", (scratch.path() / "out").string()});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("depth_m"));
}

}  // namespace
}  // namespace flowdlo
