#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "frame/temporary_folder.hpp"
#include "tools/program.hpp"

namespace flowdlo {
namespace {

using Json = nlohmann::json;
using test::run_flowdlo;
using test::TemporaryFolder;

TEST(BenchCommand, WritesTheFieldsOfTheContract) {
  const TemporaryFolder scratch;
  const auto file = scratch.path() / "bench.json";
  const auto outcome = run_flowdlo(
      scratch.path(), {"bench", test::write_frame(scratch.path()).string(), "--device", "cpu",
                       "--threads", "1", "--draws", "1", "--steps", "1", "--frames", "2",
                       "--weights", FLOWDLO_WEIGHTS, "--json", file.string()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto text = test::read_text(file);
  ASSERT_TRUE(Json::accept(text)) << text;
  const auto json = Json::parse(text);
  EXPECT_EQ(json["device"], "cpu");
  EXPECT_EQ(json["threads"], 1);
  EXPECT_EQ(json["frames"], 2);
  EXPECT_GT(json["create_ms"], 0.0);
  EXPECT_GT(json["first_ms"], 0.0);
  EXPECT_GT(json["rss_mb"], 0.0);
  EXPECT_GT(json["total_ms"]["p50"], 0.0);
  EXPECT_GT(json["stages_ms"]["model"]["p99"], 0.0);
}

TEST(BenchCommand, FrameThatShipsIsFoundBesideTheExecutable) {
  const TemporaryFolder scratch;
  const auto file = scratch.path() / "bench.json";
  const auto outcome = run_flowdlo(
      scratch.path(), {"bench", "--device", "cpu", "--draws", "1", "--steps", "1", "--frames", "1",
                       "--quiet", "--weights", FLOWDLO_WEIGHTS, "--json", file.string()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(Json::parse(test::read_text(file))["frame"], "overhand_loop");
}

TEST(BenchCommand, TheFramesOfASetTakeTurns) {
  const TemporaryFolder scratch;
  test::write_frame(scratch.path() / "set", "a");
  test::write_frame(scratch.path() / "set", "b");
  const auto file = scratch.path() / "bench.json";
  const auto outcome = run_flowdlo(
      scratch.path(), {"bench", (scratch.path() / "set").string(), "--device", "cpu", "--draws",
                       "1", "--steps", "1", "--weights", FLOWDLO_WEIGHTS, "--json", file.string()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto json = Json::parse(test::read_text(file));
  EXPECT_EQ(json["frame"], "set (2 frames)");
  EXPECT_EQ(json["frames"], 2);
  EXPECT_EQ(json["without_estimate"], 0);
  EXPECT_GE(json["total_ms"]["max"], json["total_ms"]["p50"]);
}

TEST(BenchCommand, FrameThatIsNoneEndsWithOneAndWritesNothing) {
  const TemporaryFolder scratch;
  const auto outcome =
      run_flowdlo(scratch.path(), {"bench", (scratch.path() / "none").string(), "--json",
                                   (scratch.path() / "b.json").string()});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err, "");
  EXPECT_FALSE(std::filesystem::exists(scratch.path() / "b.json"));
}

}  // namespace
}  // namespace flowdlo
