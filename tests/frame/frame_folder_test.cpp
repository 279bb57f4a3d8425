#include "flowdlo/frame_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstddef>
#include <iostream>
#include <opencv2/core.hpp>
#include <string>

#include "frame/temporary_folder.hpp"
#include "support/source_dir.hpp"

namespace flowdlo {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using test::write_frame;
using test::write_png;
using test::write_text;
using testing::HasSubstr;

constexpr std::size_t kOnRope = 30 * 80 + 40;

Error error_of(const fs::path& folder) {
  const auto loaded = load_frame_folder(folder);
  EXPECT_FALSE(loaded) << "expected an error";
  return loaded ? Error{ErrorCode::kInternal, ""} : loaded.error();
}

TEST(FrameFolder, OfOwnFormIsRead) {
  const TemporaryFolder parent;
  const auto loaded = load_frame_folder(write_frame(parent.path(), "rope"));
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->name, "rope");
  EXPECT_EQ(loaded->width, 80);
  EXPECT_EQ(loaded->height, 60);
  EXPECT_FLOAT_EQ(loaded->depth_m[kOnRope], 0.5F);
  EXPECT_FLOAT_EQ(loaded->depth_m[0], 0.6F);
  EXPECT_EQ(loaded->mask[kOnRope], 255);
  EXPECT_EQ(loaded->color_bgr[1], 20);
  EXPECT_FALSE(loaded->truth);
  EXPECT_TRUE(validate(loaded->frame()));
}

TEST(FrameFolder, NameIsTheFoldersAlsoWithATrailingSlash) {
  const TemporaryFolder parent;
  const auto loaded = load_frame_folder(write_frame(parent.path(), "rope") / "");
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->name, "rope");
}

TEST(FrameFolder, BopCameraTakesTheSizeFromTheImages) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  write_text(folder / "camera.json",
             R"({"cam_K": [100, 0, 39.5, 0, 101, 29.5, 0, 0, 1], "depth_scale": 2.0})");
  const auto loaded = load_frame_folder(folder);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->width, 80);
  EXPECT_FLOAT_EQ(loaded->intrinsics.fy, 101.0F);
  EXPECT_FLOAT_EQ(loaded->depth_m[kOnRope], 1.0F);
}

TEST(FrameFolder, Open3dCameraIsRead) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  write_text(
      folder / "camera.json",
      R"({"width": 80, "height": 60, "intrinsic_matrix": [100, 0, 0, 0, 101, 0, 39.5, 29.5, 1]})");
  const auto loaded = load_frame_folder(folder);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_FLOAT_EQ(loaded->intrinsics.cx, 39.5F);
  EXPECT_FLOAT_EQ(loaded->depth_m[kOnRope], 0.5F);
}

TEST(FrameFolder, ColourMayBeAbsent) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  fs::remove(folder / "color.png");
  const auto loaded = load_frame_folder(folder);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_TRUE(loaded->color_bgr.empty());
}

TEST(FrameFolder, GrayAndTransparentColourBecomeBgr) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  for (const int type : {CV_8UC1, CV_8UC4}) {
    write_png(folder / "color.png", cv::Mat(60, 80, type, cv::Scalar::all(77)));
    const auto loaded = load_frame_folder(folder);
    ASSERT_TRUE(loaded) << loaded.error().message;
    ASSERT_EQ(loaded->color_bgr.size(), 80U * 60U * 3U);
    EXPECT_EQ(loaded->color_bgr[2], 77);
  }
}

TEST(FrameFolder, MaskOfOneColourCountsWhateverTheColour) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  write_png(folder / "mask.png", cv::Mat(60, 80, CV_8UC3, cv::Scalar(255, 0, 0)));
  const auto loaded = load_frame_folder(folder);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->mask[0], 255);
}

TEST(FrameFolder, MaskOfZerosAndDepthOfZerosAreFramesWithoutEvidenceNotBrokenOnes) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  write_png(folder / "mask.png", cv::Mat::zeros(60, 80, CV_8UC1));
  write_png(folder / "depth.png", cv::Mat::zeros(60, 80, CV_16UC1));
  EXPECT_TRUE(load_frame_folder(folder));
}

TEST(FrameFolder, OfOnePixelIsRead) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  fs::remove(folder / "color.png");
  write_png(folder / "mask.png", cv::Mat(1, 1, CV_8UC1, cv::Scalar(255)));
  write_png(folder / "depth.png", cv::Mat(1, 1, CV_16UC1, cv::Scalar(500)));
  write_text(folder / "camera.json",
             R"({"width": 1, "height": 1, "fx": 1, "fy": 1, "cx": 0, "cy": 0,
                 "depth_scale": 0.001})");
  EXPECT_TRUE(load_frame_folder(folder));
}

TEST(FrameFolder, TruthIsReadWhenPresent) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  std::string text = "x,y,z\n";
  for (int row = 0; row < kNodes; ++row) text += std::to_string(row) + ",0,0.5\n";
  write_text(folder / "truth.csv", text);
  const auto loaded = load_frame_folder(folder);
  ASSERT_TRUE(loaded) << loaded.error().message;
  ASSERT_TRUE(loaded->truth);
  EXPECT_EQ((*loaded->truth)[63].x, 63.0F);
}

TEST(FrameFolder, BrokenTruthIsAnError) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  write_text(folder / "truth.csv", "x,y,z\n0,0,0.5\n");
  EXPECT_THAT(error_of(folder).message, HasSubstr("truth.csv: expected 64 rows"));
}

TEST(FrameFolder, ThatDoesNotExistIsAnIoError) {
  const TemporaryFolder parent;
  const auto error = error_of(parent.path() / "none");
  EXPECT_EQ(error.code, ErrorCode::kIo);
  EXPECT_THAT(error.message, HasSubstr("none: expected a folder"));
}

TEST(FrameFolder, ThatIsAFileIsAnIoError) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  EXPECT_EQ(error_of(folder / "mask.png").code, ErrorCode::kIo);
}

class NeededFile : public testing::TestWithParam<const char*> {};

TEST_P(NeededFile, MissingIsAnIoErrorThatNamesIt) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  fs::remove(folder / GetParam());
  const auto error = error_of(folder);
  EXPECT_EQ(error.code, ErrorCode::kIo);
  EXPECT_THAT(error.message, HasSubstr(std::string(GetParam()) + ": expected a file, found none"));
}

TEST_P(NeededFile, EmptyIsABadInputThatNamesIt) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  write_text(folder / GetParam(), "");
  const auto error = error_of(folder);
  EXPECT_EQ(error.code, ErrorCode::kBadInput);
  EXPECT_THAT(error.message, HasSubstr(std::string(GetParam()) + ": the file is empty"));
}

TEST_P(NeededFile, ThatIsAFolderIsAnIoError) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  fs::remove(folder / GetParam());
  fs::create_directories(folder / GetParam());
  const auto error = error_of(folder);
  EXPECT_EQ(error.code, ErrorCode::kIo);
  EXPECT_THAT(error.message, HasSubstr("got a folder"));
}

TEST_P(NeededFile, ThatIsAPipeIsNotWaitedFor) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  fs::remove(folder / GetParam());
  ASSERT_EQ(::mkfifo((folder / GetParam()).c_str(), 0600), 0);
  EXPECT_EQ(error_of(folder).code, ErrorCode::kIo);
}

TEST_P(NeededFile, OfGarbageIsABadInputThatNamesIt) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  write_text(folder / GetParam(), "\x89PNG\r\n\x1A\n garbage");
  const auto error = error_of(folder);
  EXPECT_EQ(error.code, ErrorCode::kBadInput);
  EXPECT_THAT(error.message, HasSubstr(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(FrameFolder, NeededFile,
                         testing::Values("camera.json", "depth.png", "mask.png"));

TEST(FrameFolder, DepthOfEightBitsIsRefusedAndSaysSo) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  write_png(folder / "depth.png", cv::Mat(60, 80, CV_8UC1, cv::Scalar(50)));
  const auto error = error_of(folder);
  EXPECT_EQ(error.code, ErrorCode::kBadInput);
  EXPECT_THAT(error.message,
              HasSubstr("depth.png: expected a 16-bit image of 1 channel, got 8-bit, 1 channel;"));
}

TEST(FrameFolder, LabelsOfEightAndSixteenBitsAreRead) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  EXPECT_TRUE(load_frame_folder(folder)->instances.empty());
  write_png(folder / "instances.png", cv::Mat(60, 80, CV_8UC1, cv::Scalar(3)));
  EXPECT_EQ(load_frame_folder(folder)->frame().instances[kOnRope], 3);
  write_png(folder / "instances.png", cv::Mat(60, 80, CV_16UC1, cv::Scalar(700)));
  EXPECT_EQ(load_frame_folder(folder)->frame().instances[kOnRope], 700);
}

TEST(FrameFolder, LabelsOfThreeChannelsOrAnotherSizeAreRefused) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  write_png(folder / "instances.png", cv::Mat(60, 80, CV_8UC3, cv::Scalar::all(3)));
  EXPECT_THAT(error_of(folder).message, HasSubstr("instances.png: expected one channel"));
  write_png(folder / "instances.png", cv::Mat(30, 80, CV_8UC1, cv::Scalar(3)));
  EXPECT_THAT(error_of(folder).message, HasSubstr("instances.png: expected 80 x 60 px"));
}

TEST(FrameFolder, LabelsAreSavedAndThoseOfAnEarlierFrameGo) {
  const TemporaryFolder parent;
  auto loaded = load_frame_folder(write_frame(parent.path()));
  ASSERT_TRUE(loaded);
  loaded->instances.assign(loaded->mask.size(), 0);
  loaded->instances[kOnRope] = 900;
  const auto copy = parent.path() / "copy";
  ASSERT_TRUE(save_frame_folder(copy, loaded->frame(), 0.001));
  EXPECT_EQ(load_frame_folder(copy)->instances, loaded->instances);
  loaded->instances.clear();
  ASSERT_TRUE(save_frame_folder(copy, loaded->frame(), 0.001));
  EXPECT_FALSE(fs::exists(copy / "instances.png"));
}

TEST(FrameFolder, DepthOfThreeChannelsIsRefused) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  write_png(folder / "depth.png", cv::Mat(60, 80, CV_16UC3, cv::Scalar::all(500)));
  EXPECT_THAT(error_of(folder).message, HasSubstr("got 16-bit, 3 channels"));
}

TEST(FrameFolder, MaskAndColourOfSixteenBitsAreRefused) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  write_png(folder / "mask.png", cv::Mat(60, 80, CV_16UC1, cv::Scalar(65535)));
  write_png(folder / "color.png", cv::Mat(60, 80, CV_16UC3, cv::Scalar::all(65535)));
  const auto message = error_of(folder).message;
  EXPECT_THAT(message, HasSubstr("mask.png: expected an 8-bit image"));
  EXPECT_THAT(message, HasSubstr("color.png: expected an 8-bit image"));
}

TEST(FrameFolder, MaskOfZerosAndOnesIsRefusedWithTheRemedy) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  write_png(folder / "mask.png", cv::Mat(60, 80, CV_8UC1, cv::Scalar(1)));
  EXPECT_THAT(error_of(folder).message, HasSubstr("multiply by 255"));
}

TEST(FrameFolder, MaskOfAnotherSizeIsRefusedWithBothSizes) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  write_png(folder / "mask.png", cv::Mat::zeros(30, 40, CV_8UC1));
  const auto error = error_of(folder);
  EXPECT_EQ(error.code, ErrorCode::kBadInput);
  EXPECT_THAT(error.message,
              HasSubstr("mask.png: expected 80 x 60 px as in camera.json, got 40 x 30"));
}

TEST(FrameFolder, ImagesOfAnotherSizeThanTheCameraAreRefused) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  write_text(folder / "camera.json",
             R"({"width": 640, "height": 480, "fx": 600, "fy": 600, "cx": 320, "cy": 240,
                 "depth_scale": 0.001})");
  const auto message = error_of(folder).message;
  for (const char* file : {"depth.png", "mask.png", "color.png"}) {
    EXPECT_THAT(message, HasSubstr(std::string(file) + ": expected 640 x 480 px"));
  }
}

class UnusableFocalText : public testing::TestWithParam<const char*> {};

TEST_P(UnusableFocalText, IsABadInputThatNamesTheCamera) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  write_text(folder / "camera.json", test::camera_text(GetParam()));
  const auto error = error_of(folder);
  EXPECT_EQ(error.code, ErrorCode::kBadInput);
  EXPECT_THAT(error.message, HasSubstr("camera.json: "));
}

INSTANTIATE_TEST_SUITE_P(FrameFolder, UnusableFocalText,
                         testing::Values("NaN", "Infinity", "-600", "0", "1e30", "1e999"));

TEST(FrameFolder, FaultsOfEveryFileAreListedAtOnce) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  fs::remove(folder / "depth.png");
  write_png(folder / "mask.png", cv::Mat(60, 80, CV_16UC1, cv::Scalar(1)));
  write_text(folder / "camera.json", test::camera_text("-5"));
  const auto error = error_of(folder);
  EXPECT_EQ(error.code, ErrorCode::kBadInput);
  EXPECT_THAT(error.message, HasSubstr("depth.png"));
  EXPECT_THAT(error.message, HasSubstr("mask.png"));
  EXPECT_THAT(error.message, HasSubstr("camera.json"));
  EXPECT_EQ(std::count(error.message.begin(), error.message.end(), '\n'), 2) << error.message;
}

TEST(FrameFolder, NothingIsPrintedAboutBrokenImages) {
  const TemporaryFolder parent;
  const auto folder = write_frame(parent.path());
  const auto whole = test::read_text(folder / "depth.png");
  write_text(folder / "depth.png", whole.substr(0, whole.size() / 2));
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  const auto loaded = load_frame_folder(folder);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_FALSE(loaded);
}

TEST(FrameFolder, RealRecordingsAreRead) {
  const fs::path real = test::source_dir() / ".." / "shared" / "data" / "real";
  if (!fs::is_directory(real)) {
    GTEST_SKIP() << "no recordings beside the sources: " << real;
  }
  int frames = 0;
  for (const auto& entry : fs::directory_iterator(real)) {
    if (!entry.is_directory()) continue;
    const auto loaded = load_frame_folder(entry.path());
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_GT(
        std::count_if(loaded->mask.begin(), loaded->mask.end(), [](int m) { return m > 127; }),
        1000);
    ++frames;
  }
  EXPECT_GT(frames, 0);
}

}  // namespace
}  // namespace flowdlo
