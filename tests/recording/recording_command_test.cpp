// `flowdlo estimate` and `flowdlo eval` on recordings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "flowdlo/frame_folder.hpp"
#include "frame/temporary_folder.hpp"
#include "recording/drawn_recording.hpp"
#include "tools/program.hpp"
#include "tools/view/http_client.hpp"
#include "tools/view/viewer.hpp"

namespace flowdlo {
namespace {

namespace fs = std::filesystem;
using namespace flowdlo::test;
using testing::HasSubstr;

class RecordingCommand : public testing::Test {
 protected:
  void SetUp() override { write_recording(bag(), scene_, 3, Packing::kLz4); }

  [[nodiscard]] fs::path bag() const { return scratch_.path() / "take1.bag"; }

  const lab::Scene scene_ = lab::make_scene(lab::Kind::kOneCrossing, 5);
  TemporaryFolder scratch_;
};

TEST_F(RecordingCommand, EstimatesEachFrameAsFromItsFolder) {
  const auto outcome =
      run_estimate(scratch_.path(), {bag().string(), "--hsv", kBlue, "--every", "2"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("take1.bag: 2 of 3 frames"));
  EXPECT_TRUE(fs::exists(results(scratch_.path(), "take1_000000") / "overlay.png"));
  EXPECT_FALSE(fs::exists(results(scratch_.path(), "take1_000001")));

  const fs::path folder = scratch_.path() / "folder";
  fs::create_directory(folder);
  ASSERT_TRUE(save_frame_folder(folder, scene_.frame(), 0.001));
  ASSERT_EQ(run_estimate(scratch_.path(), {folder.string()}).exit_code, 0);
  EXPECT_EQ(read_text(results(scratch_.path(), "take1_000002") / "centerline.csv"),
            read_text(results(scratch_.path(), "folder") / "centerline.csv"));
}

TEST_F(RecordingCommand, TakesTheMaskFromATopic) {
  const auto outcome = run_estimate(scratch_.path(), {bag().string(), "--mask-topic", kMask});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(estimate_json_of(scratch_.path(), "take1_000002")["status"], "ok");
}

TEST_F(RecordingCommand, IsLookedAtFrameByFrame) {
  Viewer viewer(scratch_.path(), {bag().string(), "--hsv", kBlue});
  EXPECT_EQ(body_of(viewer.get("frames.json")),
            "[\"take1_000000\",\"take1_000001\",\"take1_000002\"]");
  const auto scene = nlohmann::json::parse(body_of(viewer.get("frames/2/scene.json")));
  EXPECT_EQ(scene["width"], scene_.image.width);
  EXPECT_EQ(scene["ropes"].size(), 1U);
  EXPECT_EQ(viewer.end(SIGTERM), 0);
}

TEST_F(RecordingCommand, PipeInARecordingsPlaceIsRefusedAtOnce) {
  const auto pipe = scratch_.path() / "take2.bag";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const auto outcome = run_estimate(scratch_.path(), {pipe.string(), "--hsv", kBlue});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("take2.bag: expected a file, got a pipe"));
}

TEST_F(RecordingCommand, EvaluatesAvailabilityAndConsistency) {
  const auto out = scratch_.path() / "report";
  const auto outcome = run_flowdlo(
      scratch_.path(), {"eval", bag().string(), "--mask-topic", kMask, "--out", out.string(),
                        "--device", "cpu", "--draws", "1", "--steps", "1", "--jobs", "2"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("3 of 3 frames have an estimate, 0 have a truth"));
  EXPECT_THAT(read_text(out / "rows.csv"), HasSubstr("\ntake1_000002,"));

  // The frames lie beside the report as folders, for its pictures: the same depths, the same mask.
  const auto kept = load_frame_folder(out / "frames" / "take1" / "take1_000002");
  ASSERT_TRUE(kept) << kept.error().message;
  EXPECT_EQ(kept->mask, scene_.image.mask);
  EXPECT_TRUE(fs::exists(out / "figures")) << "overlays on frames without truth";
}

TEST_F(RecordingCommand, ShardsOfOtherThresholdsAreNotMixed) {
  const auto eval = [&](const char* shard, const char* tolerance) {
    return run_flowdlo(scratch_.path(),
                       {"eval", bag().string(), "--mask-topic", kMask, "--out",
                        (scratch_.path() / "s").string(), "--device", "cpu", "--draws", "1",
                        "--steps", "1", "--shard", shard, "--sync-tolerance", tolerance});
  };
  ASSERT_EQ(eval("1/2", "20").exit_code, 0);
  EXPECT_EQ(eval("1/2", "30").exit_code, 2);
}

TEST_F(RecordingCommand, MissingTopicIsWrongUsage) {
  const auto outcome =
      run_estimate(scratch_.path(), {bag().string(), "--hsv", kBlue, "--depth-topic", "/depth"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("the bag has:\n  /camera/aligned_depth_to_color"));
}

TEST_F(RecordingCommand, ThresholdsAreSixNumbers) {
  EXPECT_EQ(run_estimate(scratch_.path(), {bag().string(), "--hsv", "1,2,3"}).exit_code, 2);
  EXPECT_EQ(run_estimate(scratch_.path(), {bag().string(), "--hsv", "1,2,3,4,5,300"}).exit_code, 2);
}

}  // namespace
}  // namespace flowdlo
