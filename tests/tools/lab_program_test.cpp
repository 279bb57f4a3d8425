// synth and eval of flowdlo are flowdlo-lab's: the same options, messages and exit codes, whichever
// of the two was called; without flowdlo-lab the other commands go on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "command_table.hpp"
#include "frame/temporary_folder.hpp"
#include "tools/program.hpp"

namespace flowdlo {
namespace {

namespace fs = std::filesystem;
using test::run_flowdlo;
using test::run_program;
using test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A flowdlo without flowdlo-lab beside it.
fs::path lone_flowdlo(const TemporaryFolder& scratch) {
  const auto program = scratch.path() / "bin" / "flowdlo";
  fs::create_directory(program.parent_path());
  fs::copy_file(FLOWDLO_COMMAND, program);
  return program;
}

std::vector<support::CommandRow> lab_table(const TemporaryFolder& scratch) {
  return support::table_of_json(
      run_program(scratch.path(), FLOWDLO_LAB_COMMAND, {"command-table"}).out);
}

TEST(LabProgram, IsListedByFlowdloWithALineForEachOfItsTwoCommands) {
  const TemporaryFolder scratch;
  const auto help = run_flowdlo(scratch.path(), {"--help"}).out;
  EXPECT_THAT(help, ::testing::ContainsRegex("\n  synth +Synthetic frames with truth"));
  EXPECT_THAT(help, ::testing::ContainsRegex("\n  eval +Frames with truth in"));
}

TEST(LabProgram, SaysOfItsCommandsWhatItSaysItself) {
  const TemporaryFolder scratch;
  for (const std::string command : {"synth", "eval"}) {
    const auto by_flowdlo = run_flowdlo(scratch.path(), {command, "--help"});
    const auto itself = run_program(scratch.path(), FLOWDLO_LAB_COMMAND, {command, "--help"});
    EXPECT_EQ(by_flowdlo.exit_code, 0);
    EXPECT_THAT(by_flowdlo.out, HasSubstr("flowdlo " + command));
    EXPECT_EQ(by_flowdlo.out, std::regex_replace(itself.out, std::regex("flowdlo-lab " + command),
                                                 "flowdlo " + command));
  }
}

TEST(LabProgram, EndsFlowdloWithItsOwnExitCode) {
  const TemporaryFolder scratch;
  const auto outcome = run_flowdlo(scratch.path(), {"eval", "none", "--jobs", "many"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--jobs"));
  EXPECT_EQ(run_flowdlo(scratch.path(), {"eval"}).exit_code, 2);
}

TEST(LabProgram, ThatIsMissingIsNamedWithWhatToBuild) {
  const TemporaryFolder scratch;
  const auto program = lone_flowdlo(scratch);
  for (const std::string command : {"synth", "eval"}) {
    const auto outcome = run_program(scratch.path(), program, {command, "anything"});
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(
        outcome.err,
        AllOf(HasSubstr("flowdlo " + command + ": expected the program flowdlo-lab at " +
                        program.parent_path().string()),
              HasSubstr("build the target flowdlo_lab_cli"), HasSubstr("scripts/install eval")));
  }
}

TEST(LabProgram, ThatIsMissingLeavesCompletionAndManualWhole) {
  const TemporaryFolder scratch;
  const auto program = lone_flowdlo(scratch);
  const auto completion = run_program(scratch.path(), program, {"completion", "bash"});
  EXPECT_EQ(completion.exit_code, 0);
  EXPECT_THAT(completion.out,
              AllOf(HasSubstr(" eval"), HasSubstr("--draws"), Not(HasSubstr("--baselines"))));
  EXPECT_THAT(run_flowdlo(scratch.path(), {"completion", "bash"}).out, HasSubstr("--baselines"));
  const auto pages = scratch.path() / "pages";
  EXPECT_EQ(run_program(scratch.path(), program, {"manual", pages.string()}).exit_code, 0);
  EXPECT_TRUE(fs::exists(pages / "flowdlo-eval.1"));
}

TEST(LabProgram, DescribesEveryCommandAndOption) {
  const TemporaryFolder scratch;
  const auto table = lab_table(scratch);
  ASSERT_GT(table.size(), 2U);
  for (const auto& row : table) {
    const auto name = row.path.empty() ? "flowdlo-lab" : row.path.back();
    EXPECT_THAT(row.description, Not(IsEmpty())) << name;
    auto words = row.path;
    words.emplace_back("--help");
    const auto help = run_program(scratch.path(), FLOWDLO_LAB_COMMAND, words);
    EXPECT_EQ(help.exit_code, 0) << name;
    EXPECT_THAT(help.out, Not(HasSubstr("->"))) << name;
    for (const auto& option : row.options) EXPECT_THAT(option.names, Not(IsEmpty())) << name;
  }
}

TEST(LabProgram, RefusesWrongUsageOfEachOfItsCommands) {
  const TemporaryFolder scratch;
  for (const auto& row : lab_table(scratch)) {
    auto words = row.path;
    words.emplace_back("--no-such-option");
    const auto outcome = run_program(scratch.path(), FLOWDLO_LAB_COMMAND, words);
    const bool lacks_synth =
        row.path == std::vector<std::string>{"synth"} && outcome.exit_code == 1;
    EXPECT_TRUE(outcome.exit_code == 2 || lacks_synth) << outcome.err;
    EXPECT_NE(outcome.err, "");
  }
}

}  // namespace
}  // namespace flowdlo
