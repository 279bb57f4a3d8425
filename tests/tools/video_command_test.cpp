// flowdlo estimate of frames that follow each other: --stream and --video.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "frame/temporary_folder.hpp"
#include "tools/program.hpp"

namespace flowdlo {
namespace {

namespace fs = std::filesystem;
using test::estimate_json_of;
using test::results;
using test::run_estimate;
using test::TemporaryFolder;
using ::testing::HasSubstr;

bool has_ffmpeg() {
  return std::system("ffmpeg -version > /dev/null 2>&1 && ffprobe -version > /dev/null 2>&1") == 0;
}

/// An upright rope whose upper end is so many pixels to the right of the lower one.
fs::path write_leaning(const fs::path& parent, const std::string& name, int right_px) {
  const auto folder = test::write_frame(parent, name);
  cv::Mat mask(60, 80, CV_8UC1, cv::Scalar(0));
  cv::line(mask, {40 + right_px, 8}, {40, 52}, cv::Scalar(255), 5);
  cv::Mat depth(60, 80, CV_16UC1, cv::Scalar(600));
  depth.setTo(500, mask);
  test::write_png(folder / "mask.png", mask);
  test::write_png(folder / "depth.png", depth);
  return folder;
}

/// Row of node 0 above the lower end: 1, or 0.
int begins_above(const fs::path& scratch, const std::string& frame) {
  const auto nodes = estimate_json_of(scratch, frame)["nodes_m"];
  return nodes[0][1] < nodes[63][1] ? 1 : 0;
}

TEST(StreamOfFrames, KeepsTheOrderOfTheEnds) {
  const TemporaryFolder scratch;
  const auto one = write_leaning(scratch.path(), "one", -3).string();
  const auto two = write_leaning(scratch.path(), "two", 3).string();
  ASSERT_EQ(run_estimate(scratch.path(), {one, two}).exit_code, 0);
  EXPECT_EQ(begins_above(scratch.path(), "one"), 1);
  EXPECT_EQ(begins_above(scratch.path(), "two"), 0);  // the end of smaller x comes first
  ASSERT_EQ(run_estimate(scratch.path(), {one, two, "--stream"}).exit_code, 0);
  EXPECT_EQ(begins_above(scratch.path(), "one"), 1);
  EXPECT_EQ(begins_above(scratch.path(), "two"), 1);
  EXPECT_EQ(estimate_json_of(scratch.path(), "two")["reversed"], true);
}

TEST(StreamOfFrames, GoesOnAfterAFrameWithoutAnEstimate) {
  const TemporaryFolder scratch;
  const auto one = write_leaning(scratch.path(), "one", -3).string();
  const auto two = write_leaning(scratch.path(), "two", 3).string();
  const auto bad = write_leaning(scratch.path(), "bad", 0);
  test::write_png(bad / "mask.png", cv::Mat(60, 80, CV_8UC1, cv::Scalar(0)));
  EXPECT_EQ(run_estimate(scratch.path(), {one, bad.string(), two, "--stream"}).exit_code, 1);
  EXPECT_EQ(begins_above(scratch.path(), "two"), 1);
}

TEST(Video, HasAPictureOfEveryFrameWithAnEstimateOrWithout) {
  if (!has_ffmpeg()) GTEST_SKIP() << "no ffmpeg is installed";
  const TemporaryFolder scratch;
  const auto good = test::write_frame(scratch.path(), "good").string();
  const auto bad = write_leaning(scratch.path(), "bad", 0);
  test::write_png(bad / "mask.png", cv::Mat(60, 80, CV_8UC1, cv::Scalar(0)));
  const auto video = scratch.path() / "all.mp4";
  const auto outcome =
      run_estimate(scratch.path(), {good, bad.string(), "--video", video.string(), "--fps", "4"});
  EXPECT_EQ(outcome.exit_code, 1);  // of the frame without an estimate
  EXPECT_THAT(outcome.out, HasSubstr("all.mp4"));
  ASSERT_TRUE(fs::exists(video)) << outcome.err;
  const auto said = scratch.path() / "said.txt";
  const std::string line =
      "ffprobe -v error -count_frames -show_entries "
      "stream=width,height,r_frame_rate,nb_read_frames -of csv=p=0 '" +
      video.string() + "' > '" + said.string() + "'";
  ASSERT_EQ(std::system(line.c_str()), 0);
  EXPECT_EQ(test::read_text(said), "480,360,4/1,2\n");
  const auto ropes =
      run_estimate(scratch.path(), {good, "--ropes", "auto", "--video", video.string(), "--quiet"});
  EXPECT_EQ(ropes.exit_code, 0) << ropes.err;
}

TEST(Video, WithoutFfmpegIsRefusedBeforeAnyWork) {
  const TemporaryFolder scratch;
  const auto frame = test::write_frame(scratch.path()).string();
  const std::string before = std::getenv("PATH");
  ::setenv("PATH", scratch.path().c_str(), 1);
  const auto outcome =
      run_estimate(scratch.path(), {frame, "--video", (scratch.path() / "a.mp4").string()});
  ::setenv("PATH", before.c_str(), 1);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("expected the program ffmpeg"));
  EXPECT_FALSE(fs::exists(results(scratch.path(), "rope")));
}

TEST(Video, OfAnotherKindOrPlaceIsWrongUsage) {
  const TemporaryFolder scratch;
  const auto frame = test::write_frame(scratch.path()).string();
  const auto nowhere = (scratch.path() / "no" / "a.mp4").string();
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"--video", "a.avi"}, {"--video", nowhere}, {"--fps", "5"}}) {
    auto arguments = wrong;
    arguments.insert(arguments.begin(), frame);
    const auto outcome = run_estimate(scratch.path(), arguments);
    EXPECT_EQ(outcome.exit_code, 2) << wrong[0] << outcome.out;
    EXPECT_NE(outcome.err, "");
  }
}

}  // namespace
}  // namespace flowdlo
