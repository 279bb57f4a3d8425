#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "frame/temporary_folder.hpp"
#include "tools/program.hpp"

namespace flowdlo {
namespace {

using test::run_flowdlo;
using test::TemporaryFolder;
using testing::HasSubstr;

TEST(WeightsCommand, InfoNamesTensorsParametersAndChecksum) {
  const TemporaryFolder scratch;
  const auto outcome = run_flowdlo(scratch.path(), {"weights", "info", FLOWDLO_WEIGHTS});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("encoder.0.qkv.weight"));
  EXPECT_THAT(outcome.out, HasSubstr("parameters"));
  EXPECT_THAT(outcome.out, HasSubstr("sha256"));
}

TEST(WeightsCommand, ExportAndImportKeepEveryTensor) {
  const TemporaryFolder scratch;
  const auto exported = (scratch.path() / "a.safetensors").string();
  const auto imported = (scratch.path() / "a.fdw").string();
  ASSERT_EQ(run_flowdlo(scratch.path(), {"weights", "export", FLOWDLO_WEIGHTS, exported}).exit_code,
            0);
  ASSERT_EQ(run_flowdlo(scratch.path(), {"weights", "import", exported, imported}).exit_code, 0);
  EXPECT_EQ(run_flowdlo(scratch.path(), {"weights", "info", imported}).out,
            run_flowdlo(scratch.path(), {"weights", "info", FLOWDLO_WEIGHTS}).out);
}

TEST(WeightsCommand, SetFastWritesWhatQualityFastStandsForAndNothingElse) {
  const TemporaryFolder scratch;
  const auto file = (scratch.path() / "fast.fdw").string();
  const auto set = [&](const std::string& steps, const std::string& draws) {
    return run_flowdlo(scratch.path(), {"weights", "set-fast", FLOWDLO_WEIGHTS, file, "--steps",
                                        steps, "--draws", draws});
  };
  ASSERT_EQ(set("2", "1").exit_code, 0);
  const auto info = run_flowdlo(scratch.path(), {"weights", "info", file}).out;
  EXPECT_THAT(info, testing::ContainsRegex("fast_steps +2"));
  EXPECT_THAT(info, testing::ContainsRegex("fast_draws +1"));
  ASSERT_EQ(set("0", "0").exit_code, 0);
  EXPECT_EQ(run_flowdlo(scratch.path(), {"weights", "info", file}).out,
            run_flowdlo(scratch.path(), {"weights", "info", FLOWDLO_WEIGHTS}).out);
  EXPECT_EQ(set("65", "1").exit_code, 2);
}

TEST(WeightsCommand, FileThatIsNoneEndsWithOneAndNamesIt) {
  const TemporaryFolder scratch;
  const auto file = (scratch.path() / "none.fdw").string();
  const auto missing = run_flowdlo(scratch.path(), {"weights", "info", file});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.err, HasSubstr("none.fdw"));
  test::write_text(file, "these are no weights");
  const auto other = run_flowdlo(scratch.path(), {"weights", "info", file});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.err, HasSubstr("none.fdw"));
}

}  // namespace
}  // namespace flowdlo
