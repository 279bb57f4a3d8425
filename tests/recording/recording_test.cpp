#include "recording/recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "frame/temporary_folder.hpp"
#include "recording/drawn_recording.hpp"

namespace flowdlo::recording {
namespace {

namespace fs = std::filesystem;
using namespace flowdlo::test;
using testing::AllOf;
using testing::HasSubstr;

constexpr int kFrames = 6;

class RecordingTest : public testing::Test {
 protected:
  [[nodiscard]] fs::path file() const { return scratch_.path() / "rope.bag"; }

  static RecordingOptions with_mask() {
    RecordingOptions options;
    options.mask_topic = kMask;
    return options;
  }

  static RecordingOptions with_hsv() {
    RecordingOptions options;
    options.hsv = {110, 100, 50, 130, 255, 255};
    return options;
  }

  std::shared_ptr<const Recording> open(const RecordingOptions& options) {
    auto recording = Recording::open(file(), options);
    EXPECT_TRUE(recording) << recording.error().message;
    return recording ? *recording : nullptr;
  }

  std::string refusal(const RecordingOptions& options) {
    const auto recording = Recording::open(file(), options);
    return recording ? "" : recording.error().message;
  }

  const lab::Scene scene_ = lab::make_scene(lab::Kind::kSimple, 3);
  TemporaryFolder scratch_;
};

void expect_drawn(const FrameFolder& frame, const lab::Scene& scene) {
  const DrawnImages images(scene);
  ASSERT_EQ(frame.width, images.mask.cols);
  ASSERT_EQ(frame.height, images.mask.rows);
  EXPECT_EQ(frame.intrinsics.fx, scene.image.camera.fx);
  EXPECT_EQ(frame.intrinsics.cy, scene.image.camera.cy);
  EXPECT_EQ(frame.mask, scene.image.mask);
  EXPECT_EQ(std::memcmp(frame.color_bgr.data(), images.color.data, frame.color_bgr.size()), 0);
  for (std::size_t i = 0; i < frame.depth_m.size(); ++i) {
    const int depth_mm = images.depth_mm.at<std::uint16_t>(static_cast<int>(i));
    if (frame.depth_m[i] != static_cast<float>(depth_mm * 0.001)) {
      FAIL() << "depth of pixel " << i << " is " << frame.depth_m[i];
    }
  }
}

TEST_F(RecordingTest, GivesBackWhatWasDrawnHoweverItIsPacked) {
  for (const Packing packing : {Packing::kPlain, Packing::kBz2, Packing::kLz4}) {
    write_recording(file(), scene_, kFrames, packing);
    const auto recording = open(with_mask());
    ASSERT_NE(recording, nullptr);
    ASSERT_EQ(recording->size(), kFrames);
    for (const std::size_t index : {std::size_t{kFrames - 1}, std::size_t{0}}) {
      const auto frame = recording->load(index);
      ASSERT_TRUE(frame) << frame.error().message;
      expect_drawn(*frame, scene_);
    }
    EXPECT_EQ(recording->name(2), "rope_000002");
    EXPECT_THAT(recording->summary(), HasSubstr("6 of 6 frames"));
    EXPECT_THAT(recording->summary(), HasSubstr("within 4.0 ms; no distortion"));
  }
}

TEST_F(RecordingTest, MaskByThresholdsIsTheRope) {
  write_recording(file(), scene_, 1);
  const auto recording = open(with_hsv());
  ASSERT_NE(recording, nullptr);
  const auto frame = recording->load(0);
  ASSERT_TRUE(frame) << frame.error().message;
  EXPECT_EQ(frame->mask, scene_.image.mask);
}

TEST_F(RecordingTest, CompressedTopicsAreFoundByTheNameOfTheirRawOnes) {
  const DrawnImages images(scene_);
  {
    BagWriter bag(file());
    bag.camera(kInfo, kStart_ns, camera_message(scene_));
    bag.image(std::string(kDepth) + "/compressedDepth", kStart_ns,
              packed_depth_message(images.depth_mm, "16UC1; compressedDepth png"));
    bag.image(std::string(kColor) + "/compressed", kStart_ns,
              packed_message(images.color, ".png", "rgb8; png compressed bgr8"));
  }
  const auto recording = open(with_hsv());
  ASSERT_NE(recording, nullptr);
  const auto frame = recording->load(0);
  ASSERT_TRUE(frame) << frame.error().message;
  expect_drawn(*frame, scene_);
}

TEST_F(RecordingTest, FloatsInMetresAreTakenAsTheyAre) {
  const DrawnImages images(scene_);
  {
    BagWriter bag(file());
    bag.camera(kInfo, kStart_ns, camera_message(scene_));
    bag.image(kDepth, kStart_ns, raw_message(images.depth_m, "32FC1"));
    bag.image(kMask, kStart_ns, raw_message(images.mask, "mono8"));
  }
  auto options = with_mask();
  options.color_required = false;
  const auto recording = open(options);
  ASSERT_NE(recording, nullptr);
  const auto frame = recording->load(0);
  ASSERT_TRUE(frame) << frame.error().message;
  EXPECT_EQ(std::memcmp(frame->depth_m.data(), scene_.image.depth_m.data(),
                        sizeof(float) * frame->depth_m.size()),
            0);
  EXPECT_TRUE(frame->color_bgr.empty()) << "no colour was recorded, and none is needed";
}

TEST_F(RecordingTest, EveryNthAndFromToSelect) {
  write_recording(file(), scene_, kFrames);
  auto options = with_mask();
  options.every = 2;
  auto recording = open(options);
  ASSERT_EQ(recording->size(), 3U);
  EXPECT_EQ(recording->name(1), "rope_000002");
  options.every = 1;
  options.from_s = 0.2;
  options.to_s = 0.3;
  recording = open(options);
  ASSERT_EQ(recording->size(), 2U);
  EXPECT_EQ(recording->name(0), "rope_000002") << "names do not depend on the selection";
  options.from_s = 9;
  options.to_s = 10;
  EXPECT_THAT(refusal(options), HasSubstr("none lies from 9 s to 10 s"));
}

TEST_F(RecordingTest, ToleranceDecidesWhatMatches) {
  write_recording(file(), scene_, kFrames);  // jitters of -4, 3, 1, -1, -3, 4 ms
  auto options = with_mask();
  options.sync_tolerance_ms = 2;
  EXPECT_EQ(open(options)->size(), 2U);
  const DrawnImages images(scene_);
  {
    BagWriter bag(file());
    bag.camera(kInfo, kStart_ns, camera_message(scene_));
    bag.image(kDepth, kStart_ns, raw_message(images.depth_mm, "16UC1"));
    bag.image(kMask, kStart_ns + 70 * kMillisecond_ns, raw_message(images.mask, "mono8"));
  }
  options.color_required = false;
  EXPECT_THAT(refusal(options), AllOf(HasSubstr("within 2 ms, got none"), HasSubstr("70.0 ms"),
                                      HasSubstr("--sync-tolerance")));
}

TEST_F(RecordingTest, ImagesWithoutAStampCountFromTheirArrival) {
  const DrawnImages images(scene_);
  {
    BagWriter bag(file());
    bag.camera(kInfo, kStart_ns, camera_message(scene_));
    bag.image(kDepth, 0, raw_message(images.depth_mm, "16UC1"), kStart_ns);
    bag.image(kMask, 0, raw_message(images.mask, "mono8"), kStart_ns + 5 * kMillisecond_ns);
  }
  auto options = with_mask();
  options.color_required = false;
  EXPECT_THAT(open(options)->summary(), HasSubstr("within 5.0 ms"));
}

TEST_F(RecordingTest, DistortionIsUndoneAndSaid) {
  const DrawnImages images(scene_);
  auto info = camera_message(scene_);
  info.d = {-0.2, 0.05, 0.001, -0.001, 0};
  {
    BagWriter bag(file());
    bag.camera(kInfo, kStart_ns, info);
    bag.image(kDepth, kStart_ns, raw_message(images.depth_mm, "16UC1"));
    bag.image(kColor, kStart_ns, raw_message(images.rgb(), "rgb8"));
  }
  const auto bent = open(with_hsv());
  ASSERT_NE(bent, nullptr);
  EXPECT_THAT(bent->summary(), HasSubstr("plumb_bob undone, up to"));
  const auto frame = bent->load(0);
  ASSERT_TRUE(frame) << frame.error().message;
  EXPECT_NE(frame->mask, scene_.image.mask);
  auto options = with_hsv();
  options.rectified = true;
  const auto straight = open(options)->load(0);
  ASSERT_TRUE(straight);
  EXPECT_EQ(straight->mask, scene_.image.mask);
}

TEST_F(RecordingTest, MissingTopicsAreAllNamedBesideThoseThatAreThere) {
  write_recording(file(), scene_, 1);
  auto options = with_mask();
  options.depth_topic = "/depth";
  options.camera_topic = "/info";
  options.mask_topic = "/rosout";
  EXPECT_THAT(refusal(options),
              AllOf(HasSubstr("--depth-topic \"/depth\", got no message"),
                    HasSubstr("--camera-topic \"/info\", got no message"),
                    HasSubstr("--mask-topic \"/rosout\", got std_msgs/String"),
                    HasSubstr("/camera/color/camera_info (sensor_msgs/CameraInfo, 1 messages)"),
                    HasSubstr("/rope/mask (sensor_msgs/Image, 1 messages)")));
}

TEST_F(RecordingTest, NeedsOneWayToTheMask) {
  write_recording(file(), scene_, 1);
  EXPECT_THAT(refusal({}), HasSubstr("give --hsv or --mask-topic"));
  auto options = with_mask();
  options.hsv = {0, 0, 0, 1, 1, 1};
  EXPECT_THAT(refusal(options), HasSubstr("got two"));
}

TEST_F(RecordingTest, OptionsThatMeanNothingAreAllNamed) {
  auto options = with_hsv();
  options.hsv = {180, 100, 50, 130, 50, 255};
  options.sync_tolerance_ms = std::nan("");
  options.from_s = 3;
  options.to_s = 2;
  EXPECT_THAT(refusal(options),
              AllOf(HasSubstr("got 180,100,50,130,50,255"), HasSubstr("--sync-tolerance of 0 ms"),
                    HasSubstr("--from before --to, got 3 s and 2 s")));
}

TEST_F(RecordingTest, BadImageCostsItsFrameOnly) {
  const DrawnImages images(scene_);
  {
    BagWriter bag(file());
    bag.camera(kInfo, kStart_ns, camera_message(scene_));
    for (int i = 0; i < 2; ++i) {
      const Stamp at = kStart_ns + 100 * i * kMillisecond_ns;
      bag.image(kDepth, at, raw_message(images.depth_mm, i == 0 ? "16UC7" : "16UC1"));
      bag.image(kMask, at, raw_message(i == 0 ? images.mask.rowRange(0, 9) : images.mask, "mono8"));
    }
  }
  auto options = with_mask();
  options.color_required = false;
  const auto recording = open(options);
  ASSERT_NE(recording, nullptr);
  const auto bad = recording->load(0);
  ASSERT_FALSE(bad);
  EXPECT_THAT(bad.error().message, HasSubstr("aligned_depth_to_color/image_raw, message 0: "
                                             "expected an encoding of 16UC1"));
  EXPECT_TRUE(recording->load(1));
}

TEST_F(RecordingTest, ImagesOfAnotherCameraAreRefused) {
  const DrawnImages images(scene_);
  auto info = camera_message(scene_);
  info.width = 1280;
  {
    BagWriter bag(file());
    bag.camera(kInfo, kStart_ns, info);
    bag.image(kDepth, kStart_ns, raw_message(images.depth_mm, "16UC1"));
    bag.image(kColor, kStart_ns, raw_message(images.rgb(), "rgb8"));
  }
  const auto frame = open(with_hsv())->load(0);
  ASSERT_FALSE(frame);
  EXPECT_THAT(frame.error().message, HasSubstr("have to be aligned to one camera"));
}

}  // namespace
}  // namespace flowdlo::recording
