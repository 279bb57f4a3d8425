#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "flowdlo/frame_folder.hpp"
#include "flowdlo/weights.hpp"
#include "frame/temporary_folder.hpp"
#include "scene/scene.hpp"
#include "tools/program.hpp"

namespace flowdlo {
namespace {

namespace fs = std::filesystem;
using test::run_flowdlo;
using test::TemporaryFolder;
using testing::HasSubstr;
using testing::StartsWith;

fs::path save_scene(const fs::path& data_set, const std::string& name, std::uint64_t seed) {
  const auto scene = lab::make_scene(lab::Kind::kSimple, seed);
  const auto saved = save_frame_folder(data_set / name, scene.frame(), 0.0001, &scene.truth);
  EXPECT_TRUE(saved) << saved.error().message;
  return data_set / name;
}

/// A data set of one scene, "one".
fs::path one_scene(const TemporaryFolder& scratch) {
  const fs::path data_set = scratch.path() / "scenes";
  fs::create_directory(data_set);
  save_scene(data_set, "one", 1);
  return data_set;
}

test::Outcome run_eval(const fs::path& scratch, const fs::path& data_set) {
  return run_flowdlo(scratch, {"eval", data_set.string(), "--out", (scratch / "out").string(),
                               "--device", "cpu", "--draws", "1", "--steps", "1"});
}

TEST(EvalCommand, WritesTablesAndRows) {
  const TemporaryFolder scratch;
  const fs::path data_set = scratch.path() / "scenes";
  fs::create_directory(data_set);
  save_scene(data_set, "one", 1);
  save_scene(data_set, "two", 2);
  const auto outcome = run_eval(scratch.path(), data_set);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const fs::path out = scratch.path() / "out";
  for (const char* file : {"tables.md", "rows.csv", "timings.csv"}) {
    EXPECT_TRUE(fs::exists(out / file)) << file;
  }
  EXPECT_THAT(outcome.out, StartsWith(test::read_text(out / "tables.md")));
  EXPECT_THAT(outcome.out, HasSubstr("| all | 2 |"));
  EXPECT_THAT(test::read_text(out / "rows.csv"), HasSubstr("\ntwo,"));
}

TEST(EvalCommand, QualityFastNamesTheStepsAndDrawsThatRan) {
  const TemporaryFolder scratch;
  const fs::path data_set = one_scene(scratch);
  const fs::path weights = scratch.path() / "fast.fdw";
  ASSERT_TRUE(set_fast_quality(FLOWDLO_WEIGHTS, /*steps=*/3, /*draws=*/2, weights));
  const auto outcome = run_flowdlo(
      scratch.path(), {"eval", data_set.string(), "--out", (scratch.path() / "out").string(),
                       "--device", "cpu", "--weights", weights.string(), "--quality", "fast"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("2 draws of 3 steps"));
}

TEST(EvalCommand, SweepMeasuresErrorAgainstStepsAndDraws) {
  const TemporaryFolder scratch;
  const fs::path data_set = one_scene(scratch);
  const auto out = scratch.path() / "out";
  const auto outcome =
      run_flowdlo(scratch.path(), {"eval", data_set.string(), "--out", out.string(), "--device",
                                   "cpu", "--sweep-steps", "1", "--sweep-draws", "1,2"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, test::read_text(out / "sweep.md"));
  for (const char* row : {"| 10 | 4 |", "| 1 | 1 |", "| 1 | 2 |"}) {
    EXPECT_THAT(outcome.out, HasSubstr(row));
  }
}

TEST(EvalCommand, PartsAreSwitchedOnOneAfterTheOther) {
  const TemporaryFolder scratch;
  const fs::path data_set = one_scene(scratch);
  const auto out = scratch.path() / "out";
  const auto outcome = run_flowdlo(scratch.path(), {"eval", data_set.string(), "--out",
                                                    out.string(), "--device", "cpu", "--parts"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, test::read_text(out / "parts.md"));
  for (const char* row : {"| mask alone, its first prior |", "| strand field, judged |",
                          "| K = 10, D = 4: `full` |", "over 1 frames"}) {
    EXPECT_THAT(outcome.out, HasSubstr(row));
  }
}

TEST(EvalCommand, PartsOfFramesWithoutTruthAreWrongUsage) {
  const TemporaryFolder scratch;
  const fs::path data_set = one_scene(scratch);
  fs::remove(data_set / "one" / "truth.csv");
  const auto outcome = run_flowdlo(
      scratch.path(), {"eval", data_set.string(), "--out", (scratch.path() / "out").string(),
                       "--device", "cpu", "--parts"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("truth.csv"));
  EXPECT_FALSE(fs::exists(scratch.path() / "out" / "parts.md"));
}

TEST(EvalCommand, BadFrameCostsOneRow) {
  const TemporaryFolder scratch;
  const fs::path data_set = scratch.path() / "scenes";
  fs::create_directory(data_set);
  save_scene(data_set, "good", 1);
  const fs::path bad = save_scene(data_set, "bad", 2);
  fs::remove(bad / "mask.png");
  const auto outcome = run_eval(scratch.path(), data_set);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("1 of 2 frames have an estimate"));
  EXPECT_THAT(outcome.out, HasSubstr("mask.png"));
}

TEST(EvalCommand, WeightsThatAreNoneAreWrongUsage) {
  const TemporaryFolder scratch;
  const auto outcome = run_flowdlo(
      scratch.path(), {"eval", scratch.path().string(), "--out", (scratch.path() / "o").string(),
                       "--weights", (scratch.path() / "none.fdw").string()});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("none.fdw"));
  EXPECT_FALSE(fs::exists(scratch.path() / "o"));
}

TEST(EvalCommand, ChapterStandsInResultsFiguresAndReport) {
  const TemporaryFolder scratch;
  const fs::path data_set = scratch.path() / "scenes";
  const fs::path models = scratch.path() / "models";
  fs::create_directory(data_set);
  fs::create_directory(models);
  save_scene(data_set, "one", 1);
  fs::copy_file(FLOWDLO_WEIGHTS, models / "full.fdw");
  const fs::path out = scratch.path() / "out";
  const fs::path copy = scratch.path() / "copy.md";
  const auto outcome =
      run_flowdlo(scratch.path(), {"eval", data_set.string(), "--out", out.string(), "--device",
                                   "cpu", "--draws", "1", "--steps", "10", "--baselines", "all",
                                   "--models", models.string(), "--results", copy.string()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string results = test::read_text(out / "results.md");
  for (const char* table : {"Table 4.2: TrackDLO-init (scenes)", "mBEST-like path (scenes)",
                            "Table 4.4", "Table 4.5", "Table 4.7", "Calibration"}) {
    EXPECT_THAT(results, HasSubstr(table));
  }
  EXPECT_EQ(test::read_text(copy), results);
  EXPECT_THAT(test::read_text(out / "methods.csv"), HasSubstr("scenes,one,"));
  EXPECT_TRUE(fs::exists(out / "figures" / "scenes_reliability.png"));
  EXPECT_GT(fs::file_size(out / "report.html"), 500000U);

  const fs::path merged = scratch.path() / "merged";
  const auto merge =
      run_flowdlo(scratch.path(), {"eval", "merge", out.string(), "--out", merged.string()});
  ASSERT_EQ(merge.exit_code, 0) << merge.err;
  for (const char* file : {"results.md", "methods.csv", "report.html"}) {
    EXPECT_EQ(test::read_text(merged / file), test::read_text(out / file)) << file;
  }
}

TEST(EvalCommand, OtherContendersBeginAnew) {
  const TemporaryFolder scratch;
  const fs::path data_set = scratch.path() / "scenes";
  fs::create_directory(data_set);
  save_scene(data_set, "one", 1);
  ASSERT_EQ(run_eval(scratch.path(), data_set).exit_code, 0);
  const auto outcome = run_flowdlo(
      scratch.path(), {"eval", data_set.string(), "--out", (scratch.path() / "out").string(),
                       "--device", "cpu", "--draws", "1", "--steps", "1", "--baselines", "mbest"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(test::read_text(scratch.path() / "out" / "results.md"),
              HasSubstr("As Table 4.2: mBEST-like path"));
}

TEST(EvalCommand, UnknownBaselinesAreWrongUsage) {
  const TemporaryFolder scratch;
  const auto outcome = run_flowdlo(
      scratch.path(), {"eval", scratch.path().string(), "--out", (scratch.path() / "o").string(),
                       "--device", "cpu", "--baselines", "magic,all"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("\"magic\""));
  EXPECT_FALSE(fs::exists(scratch.path() / "o"));
}

TEST(EvalCommand, FolderWithoutModelsIsWrongUsage) {
  const TemporaryFolder scratch;
  const auto outcome = run_flowdlo(
      scratch.path(), {"eval", scratch.path().string(), "--out", (scratch.path() / "o").string(),
                       "--device", "cpu", "--models", scratch.path().string()});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("NAME.fdw"));
}

}  // namespace
}  // namespace flowdlo
