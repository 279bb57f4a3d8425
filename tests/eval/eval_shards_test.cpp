// `flowdlo eval` in parts, stopped, and with several jobs: the tables are those of one run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "flowdlo/frame_folder.hpp"
#include "frame/temporary_folder.hpp"
#include "scene/scene.hpp"
#include "tools/program.hpp"

namespace flowdlo {
namespace {

namespace fs = std::filesystem;
using test::read_text;
using test::run_flowdlo;
using testing::HasSubstr;

constexpr int kScenes = 5;

class EvalShards : public testing::Test {
 protected:
  void SetUp() override {
    for (int i = 0; i < kScenes; ++i) {
      const auto scene =
          lab::make_scene(i % 2 == 0 ? lab::Kind::kSimple : lab::Kind::kOneCrossing, 1 + i);
      const auto folder = path("scenes") / ("scene" + std::to_string(i));
      fs::create_directories(folder);
      ASSERT_TRUE(save_frame_folder(folder, scene.frame(), 0.0001, &scene.truth));
    }
    test::write_text(path("scenes") / "scene3" / "depth.png", "damaged");
  }

  [[nodiscard]] fs::path path(const std::string& name) const { return scratch_.path() / name; }

  test::Outcome run(const std::string& out, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"eval",     path("scenes").string(),
                                       "--out",    path(out).string(),
                                       "--device", "cpu",
                                       "--draws",  "2",
                                       "--steps",  "2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_flowdlo(scratch_.path(), arguments);
  }

  void expect_same_results(const std::string& one, const std::string& other) {
    for (const char* file : {"tables.md", "rows.csv", "methods.csv"}) {
      const auto bytes = read_text(path(one) / file);
      EXPECT_FALSE(bytes.empty()) << file;
      EXPECT_EQ(read_text(path(other) / file), bytes) << file;
    }
  }

  test::TemporaryFolder scratch_;
};

TEST_F(EvalShards, MergedAreTheBytesOfOneRun) {
  ASSERT_EQ(run("whole").exit_code, 0);
  for (const char* shard : {"3/3", "1/3", "2/3"}) {
    const auto outcome = run("parts", {"--shard", shard});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  EXPECT_FALSE(fs::exists(path("parts") / "tables.md"));
  const auto merged = run_flowdlo(
      scratch_.path(), {"eval", "merge", path("parts").string(), "--out", path("merged").string()});
  ASSERT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_THAT(merged.out, HasSubstr("4 of 5 frames have an estimate"));
  expect_same_results("whole", "merged");
}

TEST_F(EvalShards, JobsDoNotChangeTheResult) {
  ASSERT_EQ(run("one").exit_code, 0);
  ASSERT_EQ(run("three", {"--jobs", "3"}).exit_code, 0);
  expect_same_results("one", "three");
}

TEST_F(EvalShards, StoppedRunGoesOnToTheSameResult) {
  ASSERT_EQ(run("whole").exit_code, 0);
  fs::create_directory(path("stopped"));
  const auto rows = read_text(path("whole") / "rows.jsonl");
  test::write_text(path("stopped") / "rows.jsonl", rows.substr(0, rows.size() / 2));
  const auto outcome = run("stopped");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("rows of an earlier run"));
  expect_same_results("whole", "stopped");
}

TEST_F(EvalShards, DamagedFrameIsARowWithItsReason) {
  ASSERT_EQ(run("whole").exit_code, 0);
  EXPECT_THAT(read_text(path("whole") / "rows.csv"), HasSubstr("\nscene3,"));
  EXPECT_THAT(read_text(path("whole") / "tables.md"), HasSubstr("depth.png: expected a PNG"));
}

TEST_F(EvalShards, StoppedRunOfOtherOptionsIsNotContinued) {
  ASSERT_EQ(run("part", {"--shard", "1/3"}).exit_code, 0);
  const auto outcome = run("part", {"--shard", "1/3", "--seed", "5"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("seed is 0 and 5"));
}

TEST_F(EvalShards, LackingShardIsWrongUsage) {
  ASSERT_EQ(run("part", {"--shard", "1/3"}).exit_code, 0);
  const auto merged = run_flowdlo(
      scratch_.path(), {"eval", "merge", path("part").string(), "--out", path("merged").string()});
  EXPECT_EQ(merged.exit_code, 2);
  EXPECT_THAT(merged.err, HasSubstr("3 of 5 rows are lacking: scene1, scene2, scene4"));
  EXPECT_FALSE(fs::exists(path("merged")));
}

TEST_F(EvalShards, FramesBesideMergeAreWrongUsage) {
  const auto outcome =
      run_flowdlo(scratch_.path(), {"eval", path("scenes").string(), "merge",
                                    path("scenes").string(), "--out", path("o").string()});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_FALSE(fs::exists(path("o")));
}

}  // namespace
}  // namespace flowdlo
