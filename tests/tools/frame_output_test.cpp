#include "frame_output.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "files/failing_calls.hpp"
#include "flowdlo/frame_folder.hpp"
#include "frame/centerline_csv.hpp"
#include "frame/temporary_folder.hpp"
#include "tensor_files.hpp"
#include "tools/sample_estimate.hpp"

namespace flowdlo::tools {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testing::ElementsAre;

const Provenance kProvenance{"rope", "cpu", "", 10, 2, 0};

/// A frame on disk, loaded, and a folder for its results.
class FrameOutput : public testing::Test {
 protected:
  void SetUp() override {
    auto loaded = load_frame_folder(test::write_frame(parent_.path()));
    ASSERT_TRUE(loaded) << loaded.error().message;
    frame_ = *loaded;
  }

  [[nodiscard]] Result<void> write(const Tensors* tensors = nullptr,
                                   const files::SystemCalls& calls = files::kernel()) const {
    return write_estimate(out(), frame_.frame(), test::sample_estimate(), {.tensors = tensors},
                          kProvenance, Durability::kSynced, calls);
  }
  [[nodiscard]] fs::path out() const { return parent_.path() / "out" / "rope"; }
  [[nodiscard]] std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(out())) {
      names.insert(entry.path().filename().string());
    }
    return names;
  }

  test::TemporaryFolder parent_;
  FrameFolder frame_;
};

TEST_F(FrameOutput, HoldsTheThreeFilesOfTheContract) {
  ASSERT_TRUE(write());
  EXPECT_THAT(files(), ElementsAre("centerline.csv", "estimate.json", "overlay.png"));
  const auto nodes = frame::parse_centerline(test::read_text(out() / "centerline.csv"), "csv");
  ASSERT_TRUE(nodes) << nodes.error().message;
  EXPECT_EQ(*nodes, test::sample_estimate().nodes);
  EXPECT_EQ(Json::parse(test::read_text(out() / "estimate.json"))["status"], "ok");
}

TEST_F(FrameOutput, HoldsTheTensorsWhenAskedFor) {
  Tensors tensors;
  tensors.visible.resize(256 * 3);
  tensors.visible_valid.resize(256);
  tensors.prior.resize(64 * 3);
  tensors.support.resize(64);
  tensors.strands = {.width = 1, .height = 1};
  tensors.strands.channels.resize(10);
  ASSERT_TRUE(write(&tensors));
  EXPECT_EQ(files().size(), 3 + kTensorFileNames.size());
}

TEST_F(FrameOutput, HoldsTheCurveWhenAskedForAndForgetsItOtherwise) {
  const std::vector<Point3> curve{{0, 0, 1}, {0.25F, 0, 1}};
  ASSERT_TRUE(write_estimate(out(), frame_.frame(), test::sample_estimate(), {.curve = curve},
                             kProvenance));
  EXPECT_EQ(test::read_text(out() / "curve.csv"), "x,y,z\n0,0,1\n0.25,0,1\n");
  ASSERT_TRUE(write());
  EXPECT_THAT(files(), ElementsAre("centerline.csv", "estimate.json", "overlay.png"));
}

TEST_F(FrameOutput, TensorsOfAnEarlierRunDoNotStay) {
  fs::create_directories(out());
  for (const char* name : kTensorFileNames) test::write_text(out() / name, "old");
  test::write_text(out() / "notes.txt", "mine");
  ASSERT_TRUE(write());
  EXPECT_THAT(files(), ElementsAre("centerline.csv", "estimate.json", "notes.txt", "overlay.png"));
}

TEST_F(FrameOutput, NoCurveStaysBesideAFailedStatus) {
  ASSERT_TRUE(write());
  ASSERT_TRUE(write_failure(out(), {ErrorCode::kNoPath, "the mask holds no stroke"}, kProvenance));
  EXPECT_THAT(files(), ElementsAre("estimate.json"));
  EXPECT_EQ(Json::parse(test::read_text(out() / "estimate.json"))["status"], "no_path");
}

TEST_F(FrameOutput, OfSeveralRopesHasACenterlineForEach) {
  const auto ropes = test::sample_ropes();
  ASSERT_TRUE(write_ropes(out(), frame_.frame(), {ropes, {}, {}}, kProvenance));
  EXPECT_THAT(files(),
              ElementsAre("centerline.csv", "centerline_1.csv", "estimate.json", "overlay.png"));
  const auto first = frame::parse_centerline(test::read_text(out() / "centerline.csv"), "csv");
  const auto other = frame::parse_centerline(test::read_text(out() / "centerline_1.csv"), "csv");
  ASSERT_TRUE(first && other);
  EXPECT_EQ(*first, ropes.ropes[0].nodes);
  EXPECT_EQ(*other, ropes.ropes[1].nodes);
}

TEST_F(FrameOutput, RopesOfAnEarlierRunDoNotStay) {
  fs::create_directories(out());
  test::write_text(out() / "centerline_5.csv", "old");
  test::write_text(out() / "centerline_31.csv", "old");
  test::write_text(out() / "centerline_mine.csv", "mine");
  ASSERT_TRUE(write());
  EXPECT_THAT(files(),
              ElementsAre("centerline.csv", "centerline_mine.csv", "estimate.json", "overlay.png"));
}

/// A disk on which nothing more can be made; what is there can be read and removed.
class FullDisk : public test::FailingCalls {
 public:
  int openat(int folder, const char* name, int flags, mode_t mode) const override {
    return (flags & O_CREAT) == 0 ? SystemCalls::openat(folder, name, flags, mode) : full();
  }
  int mkdirat(int folder, const char* name, mode_t) const override {
    const bool there = ::faccessat(folder, name, F_OK, 0) == 0;
    return there ? failed(EEXIST) : full();
  }
  ssize_t write(int, const void*, std::size_t) const override { return full(); }

 private:
  static int failed(int code) {
    errno = code;
    return -1;
  }
  static int full() { return failed(ENOSPC); }
};

TEST_F(FrameOutput, NoResultOfAnEarlierRunStandsBesideAFullDisk) {
  ASSERT_TRUE(write());
  const auto done = write(nullptr, FullDisk());
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error().message, testing::HasSubstr("No space left on device; make space"));
  EXPECT_THAT(files(), testing::IsEmpty());

  ASSERT_TRUE(write());
  EXPECT_FALSE(write_failure(out(), {ErrorCode::kNoPath, "no stroke"}, kProvenance,
                             Durability::kSynced, FullDisk()));
  EXPECT_THAT(files(), testing::IsEmpty());
}

TEST_F(FrameOutput, FailingAtAnyCallLeavesNoCurveBesideAnotherRunsStatus) {
  const test::FailingCalls counting;
  ASSERT_TRUE(write(nullptr, counting));
  for (int at = 0; at < counting.count(); ++at) {
    ASSERT_TRUE(write(nullptr, test::FailingCalls()));
    test::write_text(out() / "estimate.json", "{\"status\": \"old\"}");
    const auto done = write(nullptr, test::FailingCalls({test::Fault::Kind::kKilled, EIO, at}));
    const auto status = test::read_text(out() / "estimate.json");
    if (status.find("\"old\"") != std::string::npos) {
      EXPECT_EQ(files().count("centerline.csv"), 1) << "nothing was touched before it went: " << at;
      EXPECT_FALSE(done);
    }
    EXPECT_TRUE(!done || Json::parse(status)["status"] == "ok") << at;
  }
}

TEST_F(FrameOutput, ForgottenIsWhatAnEarlierRunWroteAndNothingElse) {
  ASSERT_TRUE(write());
  test::write_text(out() / "notes.txt", "mine");
  ASSERT_TRUE(forget_results(out()));
  EXPECT_THAT(files(), ElementsAre("notes.txt"));
  EXPECT_TRUE(forget_results(parent_.path() / "none"));
  EXPECT_FALSE(fs::exists(parent_.path() / "none"));
}

TEST_F(FrameOutput, PlantedLinksAreReplacedAndTheirTargetsLeft) {
  const auto victim = parent_.path() / "victim";
  test::write_text(victim, "precious");
  fs::create_directories(out());
  for (const char* name : {"centerline.csv", "estimate.json", "overlay.png"}) {
    fs::create_symlink(victim, out() / name);
  }
  ASSERT_TRUE(write());
  EXPECT_EQ(test::read_text(victim), "precious");
  EXPECT_EQ(Json::parse(test::read_text(out() / "estimate.json"))["status"], "ok");
}

TEST_F(FrameOutput, TensorsOfTheWrongShapeWriteNothing) {
  const Tensors empty;
  const auto done = write(&empty);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::kInternal);
  EXPECT_THAT(files(), testing::IsEmpty());
}

TEST_F(FrameOutput, FileInPlaceOfTheFolderIsAnIoError) {
  fs::create_directories(out().parent_path());
  test::write_text(out(), "in the way");
  const auto done = write();
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace flowdlo::tools
