#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/core.hpp>
#include <ostream>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "frame/centerline_csv.hpp"
#include "frame/temporary_folder.hpp"
#include "support/source_dir.hpp"
#include "tools/program.hpp"

namespace flowdlo {
namespace {

namespace fs = std::filesystem;
using test::estimate_json_of;
using test::results;
using test::run_estimate;
using test::TemporaryFolder;
using test::write_frame;
using test::write_png;
using test::write_text;
using testing::HasSubstr;

std::set<std::string> files_in(const fs::path& folder) {
  std::set<std::string> names;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

TEST(EstimateCommand, WritesTheThreeFilesOfAFrame) {
  const TemporaryFolder scratch;
  const auto outcome = run_estimate(scratch.path(), {write_frame(scratch.path()).string()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(files_in(results(scratch.path(), "rope")),
            (std::set<std::string>{"centerline.csv", "estimate.json", "overlay.png"}));
  const auto json = estimate_json_of(scratch.path(), "rope");
  EXPECT_EQ(json["status"], "ok");
  EXPECT_EQ(json["device"], "cpu");
  EXPECT_EQ(json["support"].size(), 64U);
  EXPECT_EQ(json["sigma_m"].size(), 64U);
  EXPECT_EQ(json["draws"].size(), 1U);
  EXPECT_GT(json["timings_ms"]["total"], 0.0);
}

TEST(EstimateCommand, NodesLieAtTheDepthOfTheRope) {
  const TemporaryFolder scratch;
  ASSERT_EQ(run_estimate(scratch.path(), {write_frame(scratch.path()).string()}).exit_code, 0);
  const auto text = test::read_text(results(scratch.path(), "rope") / "centerline.csv");
  const auto nodes = frame::parse_centerline(text, "centerline.csv");
  ASSERT_TRUE(nodes) << nodes.error().message;
  for (const auto& node : *nodes) EXPECT_NEAR(node.z, 0.5F, 0.1F);
}

TEST(EstimateCommand, RefinedPriorLiesBehindTheSurfaceThatTheThesisPriorLiesOn) {
  const TemporaryFolder scratch;
  const auto frame = write_frame(scratch.path()).string();
  const auto middle_depth = [&](const std::string& kind) {
    EXPECT_EQ(run_estimate(scratch.path(), {frame, "--prior", kind}).exit_code, 0);
    const auto text = test::read_text(results(scratch.path(), "rope") / "centerline.csv");
    const auto nodes = frame::parse_centerline(text, "centerline.csv");
    EXPECT_TRUE(nodes);
    return nodes ? (*nodes)[kNodes / 2].z : 0.0F;
  };
  EXPECT_GT(middle_depth("refined"), middle_depth("thesis"));
}

// A second rope, upright, in the frame that write_frame makes: across the first one and nearer.
void add_rope(const fs::path& folder, bool labels) {
  cv::Mat mask = cv::Mat::zeros(60, 80, CV_8UC1);
  cv::Mat depth(60, 80, CV_16UC1, cv::Scalar(600));
  cv::Mat instances = cv::Mat::zeros(60, 80, CV_8UC1);
  const auto draw = [&](const cv::Rect& where, int depth_mm, int label) {
    mask(where).setTo(255);
    depth(where).setTo(depth_mm);
    instances(where).setTo(label);
  };
  draw({10, 28, 60, 5}, 500, 4);
  draw({38, 4, 5, 52}, 480, 9);
  write_png(folder / "mask.png", mask);
  write_png(folder / "depth.png", depth);
  if (labels) write_png(folder / "instances.png", instances);
}

TEST(EstimateCommand, RopesAreWrittenEachAndThoseOfAnEarlierRunGo) {
  const TemporaryFolder scratch;
  const auto folder = write_frame(scratch.path());
  add_rope(folder, false);
  const auto outcome = run_estimate(scratch.path(), {folder.string(), "--ropes", "auto"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("2 ropes, 1 crossing"));
  EXPECT_EQ(files_in(results(scratch.path(), "rope")),
            (std::set<std::string>{"centerline.csv", "centerline_1.csv", "estimate.json",
                                   "overlay.png"}));
  const auto json = estimate_json_of(scratch.path(), "rope");
  ASSERT_EQ(json["ropes"].size(), 2U);
  ASSERT_EQ(json["ropes"][0]["crossings"].size(), 1U);
  EXPECT_EQ(json["ropes"][0]["crossings"][0]["over"], false);  // the longer one lies below
  ASSERT_EQ(run_estimate(scratch.path(), {folder.string()}).exit_code, 0);
  EXPECT_FALSE(fs::exists(results(scratch.path(), "rope") / "centerline_1.csv"));
  EXPECT_FALSE(estimate_json_of(scratch.path(), "rope").contains("ropes"));
}

TEST(EstimateCommand, RopesOfAStreamKeepTheirNumbers) {
  const TemporaryFolder scratch;
  const auto both = write_frame(scratch.path(), "both");
  add_rope(both, false);
  const auto one = write_frame(scratch.path(), "one");
  const auto again = write_frame(scratch.path(), "again");
  add_rope(again, false);
  const auto outcome = run_estimate(
      scratch.path(), {both.string(), one.string(), again.string(), "--ropes", "auto", "--stream"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto last = estimate_json_of(scratch.path(), "again");
  EXPECT_EQ(last["ropes"][0]["number"], 1);
  EXPECT_EQ(last["ropes"][1]["number"], 2);
  EXPECT_TRUE(last["missing"].empty());
  const auto middle = estimate_json_of(scratch.path(), "one");
  ASSERT_EQ(middle["ropes"].size(), 1U);
  EXPECT_EQ(middle["ropes"][0]["number"], 1);
  ASSERT_EQ(middle["missing"].size(), 1U);
  EXPECT_EQ(middle["missing"][0], 2);
  ASSERT_EQ(run_estimate(scratch.path(), {both.string(), "--ropes", "auto"}).exit_code, 0);
  EXPECT_FALSE(estimate_json_of(scratch.path(), "both").contains("missing"));
}

TEST(EstimateCommand, ResultsDoNotGoWhereTheFrameIs) {
  const TemporaryFolder scratch;
  const auto folder = write_frame(scratch.path());
  test::write_text(folder / "curve.csv", "mine");
  const auto outcome = test::run_flowdlo(
      scratch.path(), {"estimate", folder.string(), "--out", scratch.path().string()});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("is a frame itself"));
  EXPECT_EQ(test::read_text(folder / "curve.csv"), "mine");
}

TEST(EstimateCommand, LabelsBesideAFrameTellItsRopes) {
  const TemporaryFolder scratch;
  const auto folder = write_frame(scratch.path());
  add_rope(folder, true);
  ASSERT_EQ(run_estimate(scratch.path(), {folder.string(), "--ropes", "1"}).exit_code, 0);
  EXPECT_EQ(estimate_json_of(scratch.path(), "rope")["ropes"].size(), 2U);
}

TEST(EstimateCommand, NumbersOfRopesThatCannotBeAreWrongUsage) {
  const TemporaryFolder scratch;
  const auto frame = write_frame(scratch.path()).string();
  for (const char* number : {"0", "33", "-1", "many", "2.5", "1e1", "3x"}) {
    EXPECT_EQ(run_estimate(scratch.path(), {frame, "--ropes", number}).exit_code, 2) << number;
  }
  EXPECT_EQ(run_estimate(scratch.path(), {frame, "--ropes", "2", "--tensors"}).exit_code, 2);
}

Centerline nodes_in(const fs::path& scratch) {
  const auto text = test::read_text(results(scratch, "rope") / "centerline.csv");
  const auto nodes = frame::parse_centerline(text, "centerline.csv");
  if (!nodes) throw std::runtime_error(nodes.error().message);
  return *nodes;
}

TEST(EstimateCommand, HintsTurnTheNodesAndSaySo) {
  const TemporaryFolder scratch;
  const auto frame = write_frame(scratch.path()).string();
  ASSERT_EQ(run_estimate(scratch.path(), {frame}).exit_code, 0);
  const Centerline plain = nodes_in(scratch.path());
  EXPECT_EQ(estimate_json_of(scratch.path(), "rope")["reversed"], false);
  const auto outcome =
      run_estimate(scratch.path(), {"--first-end", "79,30", "--end", "79,30", frame});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  Centerline turned = nodes_in(scratch.path());
  EXPECT_EQ(estimate_json_of(scratch.path(), "rope")["reversed"], true);
  EXPECT_GT(turned.front().x, turned.back().x);
  fs::rename(results(scratch.path(), "rope") / "estimate.json", scratch.path() / "before.json");
  ASSERT_EQ(
      run_estimate(scratch.path(), {frame, "--previous", (scratch.path() / "before.json").string()})
          .exit_code,
      0);
  EXPECT_GT(nodes_in(scratch.path()).front().x, nodes_in(scratch.path()).back().x);
  std::reverse(turned.begin(), turned.end());
  EXPECT_EQ(turned, plain);
}

TEST(EstimateCommand, APlaceFarOutsideOfTheFrameIsAFaultOfThatFrame) {
  const TemporaryFolder scratch;
  const auto frame = write_frame(scratch.path()).string();
  const auto outcome = run_estimate(scratch.path(), {frame, "--first-end", "5000,30"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(estimate_json_of(scratch.path(), "rope")["status"], "bad_input");
  EXPECT_THAT(outcome.err, HasSubstr("Hints.first_end"));
}

TEST(EstimateCommand, TheCurveIsAsDenseAsAsked) {
  const TemporaryFolder scratch;
  const auto frame = write_frame(scratch.path()).string();
  ASSERT_EQ(run_estimate(scratch.path(), {frame, "--curve", "200"}).exit_code, 0);
  const auto text = test::read_text(results(scratch.path(), "rope") / "curve.csv");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 201);
  ASSERT_EQ(run_estimate(scratch.path(), {frame}).exit_code, 0);
  EXPECT_FALSE(fs::exists(results(scratch.path(), "rope") / "curve.csv"));
}

TEST(EstimateCommand, UnknownKindOfPriorAndNegativeLengthAreWrongUsage) {
  const TemporaryFolder scratch;
  const auto frame = write_frame(scratch.path()).string();
  EXPECT_EQ(run_estimate(scratch.path(), {frame, "--prior", "best"}).exit_code, 2);
  EXPECT_EQ(run_estimate(scratch.path(), {frame, "--rope-length", "-1"}).exit_code, 2);
}

TEST(EstimateCommand, TensorsAreWrittenOnRequest) {
  const TemporaryFolder scratch;
  ASSERT_EQ(
      run_estimate(scratch.path(), {write_frame(scratch.path()).string(), "--tensors"}).exit_code,
      0);
  for (const char* name :
       {"source.npy", "visible.npy", "visible_valid.npy", "path.npy", "prior.npy", "support.npy",
        "draw_prior.npy", "draw_support.npy", "prediction.npy", "mask_field.npy"}) {
    EXPECT_TRUE(fs::exists(results(scratch.path(), "rope") / name)) << name;
  }
  EXPECT_THAT(test::read_text(results(scratch.path(), "rope") / "mask_field.npy"),
              HasSubstr("(4, 30, 40)"));
}

TEST(EstimateCommand, TakesTheWeightsOwnDrawsUnlessStepsTensorsOrAllOfThemAreAskedFor) {
  const TemporaryFolder scratch;
  const auto frame = write_frame(scratch.path()).string();
  const auto file = (scratch.path() / "fast.fdw").string();
  ASSERT_EQ(test::run_flowdlo(scratch.path(), {"weights", "set-fast", FLOWDLO_WEIGHTS, file,
                                               "--steps", "1", "--draws", "2"})
                .exit_code,
            0);
  const auto draws_with = [&](const std::vector<std::string>& options) {
    std::vector<std::string> line{"estimate", frame, "--out",     (scratch.path() / "out").string(),
                                  "--device", "cpu", "--weights", file};
    line.insert(line.end(), options.begin(), options.end());
    EXPECT_EQ(test::run_flowdlo(scratch.path(), line).exit_code, 0);
    return estimate_json_of(scratch.path(), "rope")["draws"].size();
  };
  EXPECT_EQ(draws_with({}), 2U);
  EXPECT_EQ(draws_with({"--quality", "full"}), 4U);
  EXPECT_EQ(draws_with({"--steps", "10"}), 4U) << "also where it is what full has";
  EXPECT_EQ(draws_with({"--tensors"}), 4U);
  EXPECT_EQ(draws_with({"--tensors", "--quality", "fast"}), 2U);
  EXPECT_EQ(draws_with({"--gate", "thesis"}), 4U);
}

TEST(EstimateCommand, TheStrandFieldIsWrittenAndDrawnOnRequest) {
  const TemporaryFolder scratch;
  const auto frame = write_frame(scratch.path()).string();
  const auto picture = results(scratch.path(), "rope") / "overlay.png";
  ASSERT_EQ(run_estimate(scratch.path(), {frame}).exit_code, 0);
  const auto plain = test::read_text(picture);
  ASSERT_EQ(run_estimate(scratch.path(), {frame, "--field-weights", FLOWDLO_FIELD_WEIGHTS,
                                          "--tensors", "--overlay", "field"})
                .exit_code,
            0);
  for (const char* name : {"field.npy", "field_region.json"}) {
    EXPECT_TRUE(fs::exists(results(scratch.path(), "rope") / name)) << name;
  }
  EXPECT_NE(test::read_text(picture), plain);
  EXPECT_EQ(run_estimate(scratch.path(), {frame, "--overlay", "nothing"}).exit_code, 2);
}

TEST(EstimateCommand, QuietPrintsNothing) {
  const TemporaryFolder scratch;
  const auto outcome =
      run_estimate(scratch.path(), {write_frame(scratch.path()).string(), "--quiet"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
}

TEST(EstimateCommand, DataSetIsEstimatedFrameByFrame) {
  const TemporaryFolder scratch;
  write_frame(scratch.path() / "set", "a");
  write_frame(scratch.path() / "set", "b");
  const auto outcome = run_estimate(scratch.path(), {(scratch.path() / "set").string()});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(estimate_json_of(scratch.path(), "a")["status"], "ok");
  EXPECT_EQ(estimate_json_of(scratch.path(), "b")["status"], "ok");
}

TEST(EstimateCommand, OneBrokenFrameEndsWithOneAndLeavesTheOthersWhole) {
  const TemporaryFolder scratch;
  const auto broken = write_frame(scratch.path(), "broken");
  fs::remove(broken / "depth.png");
  const auto outcome = run_estimate(
      scratch.path(), {broken.string(), write_frame(scratch.path(), "whole").string()});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(estimate_json_of(scratch.path(), "broken")["status"], "io");
  EXPECT_EQ(estimate_json_of(scratch.path(), "whole")["status"], "ok");
  EXPECT_THAT(outcome.err, HasSubstr("depth.png"));
}

TEST(EstimateCommand, NoCurveOfAnEarlierRunStaysBesideAFailedStatus) {
  const TemporaryFolder scratch;
  const auto folder = write_frame(scratch.path());
  ASSERT_EQ(run_estimate(scratch.path(), {folder.string(), "--tensors"}).exit_code, 0);
  write_png(folder / "mask.png", cv::Mat::zeros(60, 80, CV_8UC1));
  EXPECT_EQ(run_estimate(scratch.path(), {folder.string()}).exit_code, 1);
  EXPECT_EQ(files_in(results(scratch.path(), "rope")), (std::set<std::string>{"estimate.json"}));
}

/// A frame made unusable, and what estimate.json has to say about it.
struct Fault {
  const char* name;
  void (*cause)(const fs::path& folder);
  const char* status;  ///< regular expression
  const char* word;    ///< of the sentence

  friend void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }
};

class BrokenFrame : public testing::TestWithParam<Fault> {};

TEST_P(BrokenFrame, EndsWithOneAStatusAndASentence) {
  const TemporaryFolder scratch;
  const auto folder = write_frame(scratch.path());
  GetParam().cause(folder);
  const auto outcome = run_estimate(scratch.path(), {folder.string()});
  EXPECT_EQ(outcome.exit_code, 1) << outcome.out << outcome.err;
  EXPECT_EQ(files_in(results(scratch.path(), "rope")), (std::set<std::string>{"estimate.json"}));
  const auto json = estimate_json_of(scratch.path(), "rope");
  ASSERT_TRUE(json.is_object());
  EXPECT_THAT(json["status"].get<std::string>(), testing::MatchesRegex(GetParam().status));
  EXPECT_THAT(json["message"].get<std::string>(), HasSubstr(GetParam().word));
  EXPECT_THAT(outcome.err, HasSubstr(GetParam().word));
}

void write_camera(const fs::path& folder, const char* fx) {
  write_text(folder / "camera.json", test::camera_text(fx));
}

void shrink_to_one_pixel(const fs::path& folder) {
  write_png(folder / "color.png", cv::Mat(1, 1, CV_8UC3, cv::Scalar::all(9)));
  write_png(folder / "mask.png", cv::Mat(1, 1, CV_8UC1, cv::Scalar(255)));
  write_png(folder / "depth.png", cv::Mat(1, 1, CV_16UC1, cv::Scalar(500)));
  write_text(folder / "camera.json",
             R"({"width": 1, "height": 1, "fx": 100, "fy": 100, "cx": 0, "cy": 0,
                 "depth_scale": 0.001})");
}

INSTANTIATE_TEST_SUITE_P(
    EstimateCommand, BrokenFrame,
    testing::Values(
        Fault{"MissingFolder", [](const fs::path& f) { fs::remove_all(f); }, "io", "rope"},
        Fault{"MissingDepth", [](const fs::path& f) { fs::remove(f / "depth.png"); }, "io",
              "depth.png"},
        Fault{"MissingMask", [](const fs::path& f) { fs::remove(f / "mask.png"); }, "io",
              "mask.png"},
        Fault{"MissingCamera", [](const fs::path& f) { fs::remove(f / "camera.json"); }, "io",
              "camera.json"},
        Fault{"EmptyDepth", [](const fs::path& f) { write_text(f / "depth.png", ""); }, "bad_input",
              "empty"},
        Fault{"CorruptMask",
              [](const fs::path& f) { write_text(f / "mask.png", "\x89PNG rubbish"); }, "bad_input",
              "mask.png"},
        Fault{"FolderInPlaceOfDepth",
              [](const fs::path& f) {
                fs::remove(f / "depth.png");
                fs::create_directories(f / "depth.png");
              },
              "io", "folder"},
        Fault{"MaskOfAnotherSize",
              [](const fs::path& f) { write_png(f / "mask.png", cv::Mat::zeros(30, 40, CV_8UC1)); },
              "bad_input", "40 x 30"},
        Fault{"DepthOfEightBits",
              [](const fs::path& f) {
                write_png(f / "depth.png", cv::Mat(60, 80, CV_8UC1, cv::Scalar(50)));
              },
              "bad_input", "16-bit"},
        Fault{"MaskOfZeros",
              [](const fs::path& f) { write_png(f / "mask.png", cv::Mat::zeros(60, 80, CV_8UC1)); },
              "no_evidence|no_path", "mask"},
        Fault{
            "NoDepth",
            [](const fs::path& f) { write_png(f / "depth.png", cv::Mat::zeros(60, 80, CV_16UC1)); },
            "no_evidence", "depth"},
        Fault{"NanFocalLength", [](const fs::path& f) { write_camera(f, "NaN"); }, "bad_input",
              "camera.json"},
        Fault{"NegativeFocalLength", [](const fs::path& f) { write_camera(f, "-600"); },
              "bad_input", "fx"},
        Fault{"FocalLengthOfText", [](const fs::path& f) { write_camera(f, "\"600\""); },
              "bad_input", "expected a number"},
        Fault{"OnePixel", shrink_to_one_pixel, "no_path|no_evidence", ""}),
    [](const auto& fault) { return std::string(fault.param.name); });

TEST(EstimateCommand, RealRecordingsHaveSixtyFourNodesAtTheirDepth) {
  const fs::path real = test::source_dir() / ".." / "shared" / "data" / "real";
  if (!fs::is_directory(real)) GTEST_SKIP() << "no recordings beside the sources: " << real;
  const TemporaryFolder scratch;
  const auto outcome = run_estimate(scratch.path(), {real.string(), "--quiet"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  int frames = 0;
  for (const auto& entry : fs::directory_iterator(scratch.path() / "out")) {
    const auto text = test::read_text(entry.path() / "centerline.csv");
    const auto nodes = frame::parse_centerline(text, entry.path().string());
    ASSERT_TRUE(nodes) << nodes.error().message;
    for (const auto& node : *nodes) {
      EXPECT_GT(node.z, 0.3F) << entry.path();
      EXPECT_LT(node.z, 0.5F) << entry.path();
    }
    ++frames;
  }
  EXPECT_EQ(frames, 5);
}

}  // namespace
}  // namespace flowdlo
