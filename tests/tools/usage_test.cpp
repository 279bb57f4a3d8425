// Wrong usage ends with 2 and a sentence, and leaves no results.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "frame/temporary_folder.hpp"
#include "tools/program.hpp"

namespace flowdlo {
namespace {

namespace fs = std::filesystem;
using test::run_estimate;
using test::run_flowdlo;
using test::TemporaryFolder;
using testing::HasSubstr;

TEST(Usage, VersionAndHelpEndWithZero) {
  const TemporaryFolder scratch;
  const auto version = run_flowdlo(scratch.path(), {"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_THAT(version.out, testing::StartsWith("flowdlo "));
  EXPECT_EQ(run_flowdlo(scratch.path(), {"--help"}).exit_code, 0);
  EXPECT_EQ(run_flowdlo(scratch.path(), {"estimate", "--help"}).exit_code, 0);
}

class WrongUsage : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(WrongUsage, EndsWithTwoAndASentence) {
  const TemporaryFolder scratch;
  const auto outcome = run_flowdlo(scratch.path(), GetParam());
  EXPECT_EQ(outcome.exit_code, 2) << outcome.out << outcome.err;
  EXPECT_NE(outcome.err, "");
}

using Arguments = std::vector<std::string>;
INSTANTIATE_TEST_SUITE_P(Usage, WrongUsage,
                         testing::Values(Arguments{}, Arguments{"fly"}, Arguments{"estimate"},
                                         Arguments{"estimate", "f"}, Arguments{"weights"},
                                         Arguments{"weights", "info"},
                                         Arguments{"devices", "--what"},
                                         Arguments{"bench", "--frames", "0"},
                                         Arguments{"bench", "--frames", "many"}));

class WrongOption : public testing::TestWithParam<Arguments> {};

TEST_P(WrongOption, EndsWithTwoAndWritesNoResult) {
  const TemporaryFolder scratch;
  Arguments arguments = {"estimate", test::write_frame(scratch.path()).string(), "--out",
                         (scratch.path() / "out").string()};
  arguments.insert(arguments.end(), GetParam().begin(), GetParam().end());
  const auto outcome = run_flowdlo(scratch.path(), arguments);
  EXPECT_EQ(outcome.exit_code, 2) << outcome.out << outcome.err;
  EXPECT_NE(outcome.err, "");
  EXPECT_FALSE(fs::exists(scratch.path() / "out" / "rope"));
}

INSTANTIATE_TEST_SUITE_P(
    Usage, WrongOption,
    testing::Values(Arguments{"--steps", "0"}, Arguments{"--steps", "65"},
                    Arguments{"--steps", "ten"}, Arguments{"--draws", "0"},
                    Arguments{"--draws", "65"}, Arguments{"--seed", "-1"},
                    Arguments{"--seed", "1.5"}, Arguments{"--seed", "18446744073709551616"},
                    Arguments{"--threads", "-1"}, Arguments{"--weights", "none.fdw"},
                    Arguments{"--first-end", "12"}, Arguments{"--first-end", "12,nan"},
                    Arguments{"--end", "12;7"}, Arguments{"--end", "1,2", "--end", "three,4"},
                    Arguments{"--ring", "--end", "1,2"}, Arguments{"--ring", "--ropes", "2"},
                    Arguments{"--previous", "none.json"}, Arguments{"--curve", "1"},
                    Arguments{"--curve", "65537"}, Arguments{"--device", "Abacus 3000"}));

TEST(Usage, FramesOfOneNameAreRefusedBeforeAnyWork) {
  const TemporaryFolder scratch;
  const auto one = test::write_frame(scratch.path() / "one");
  const auto two = test::write_frame(scratch.path() / "two");
  const auto outcome = run_estimate(scratch.path(), {one.string(), two.string()});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("two frames are named \"rope\""));
  EXPECT_FALSE(fs::exists(scratch.path() / "out"));
}

TEST(Usage, OutThatIsAFileIsRefused) {
  const TemporaryFolder scratch;
  test::write_text(scratch.path() / "out", "in the way");
  const auto outcome = run_estimate(scratch.path(), {test::write_frame(scratch.path()).string()});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--out"));
}

}  // namespace
}  // namespace flowdlo
