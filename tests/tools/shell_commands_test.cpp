// What a shell, man(1) and somebody who mistypes are told of the command.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "frame/temporary_folder.hpp"
#include "tools/program.hpp"

namespace flowdlo {
namespace {

namespace fs = std::filesystem;
using test::run_flowdlo;
using test::TemporaryFolder;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

bool has_program(const std::string& name) {
  return std::system(("command -v " + name + " > /dev/null 2>&1").c_str()) == 0;
}

/// Options as `flowdlo COMMAND --help` lists them.
std::set<std::string> options_of(const fs::path& scratch, const std::string& command) {
  const auto help = run_flowdlo(scratch, {command, "--help"}).out;
  static const std::regex option(R"(\n  (?:-\w,)?(--[a-z-]+))");
  std::set<std::string> found;
  for (std::sregex_iterator it(help.begin(), help.end(), option), end; it != end; ++it) {
    found.insert((*it)[1]);
  }
  return found;
}

/// What bash offers for the last of `words`.
std::set<std::string> offered_by_bash(const fs::path& scratch,
                                      const std::vector<std::string>& words) {
  const auto script = scratch / "flowdlo.bash";
  test::write_text(script, run_flowdlo(scratch, {"completion", "bash"}).out);
  std::string line = "source '" + script.string() + "'; COMP_WORDS=(flowdlo";
  for (const auto& word : words) line += " '" + word + "'";
  line += "); COMP_CWORD=" + std::to_string(words.size()) +
          "; _flowdlo; printf '%s\\n' \"${COMPREPLY[@]}\"";
  const auto asked = scratch / "asked.sh";
  test::write_text(asked, line);
  const auto answer = scratch / "answer.txt";
  if (std::system(("bash '" + asked.string() + "' > '" + answer.string() + "'").c_str()) != 0) {
    return {};
  }
  std::set<std::string> found;
  std::string word;
  for (const char letter : test::read_text(answer)) {
    if (letter != '\n') {
      word += letter;
    } else {
      found.insert(word);
      word.clear();
    }
  }
  return found;
}

class BashCompletion : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_program("bash")) GTEST_SKIP() << "bash is not installed";
  }
  TemporaryFolder scratch_;
};

TEST_F(BashCompletion, OffersCommandsThatBeginSo) {
  EXPECT_EQ(offered_by_bash(scratch_.path(), {"e"}), (std::set<std::string>{"estimate", "eval"}));
  EXPECT_THAT(offered_by_bash(scratch_.path(), {""}), Contains("weights"));
  EXPECT_EQ(offered_by_bash(scratch_.path(), {"weights", "ex"}), (std::set<std::string>{"export"}));
}

TEST_F(BashCompletion, OffersEveryOptionOfTheHelp) {
  for (const char* command : {"estimate", "mask", "bench", "eval"}) {
    const auto offered = offered_by_bash(scratch_.path(), {command, "frame", "--"});
    EXPECT_THAT(offered, ::testing::IsSupersetOf(options_of(scratch_.path(), command))) << command;
  }
}

TEST_F(BashCompletion, OffersTheChoicesOfAnOption) {
  EXPECT_EQ(offered_by_bash(scratch_.path(), {"estimate", "frame", "--quality", ""}),
            (std::set<std::string>{"auto", "full", "fast"}));
  EXPECT_EQ(offered_by_bash(scratch_.path(), {"eval", "set", "--gate", "c"}),
            (std::set<std::string>{"calibrated"}));
}

TEST_F(BashCompletion, LeavesFilesToTheShell) {
  EXPECT_EQ(offered_by_bash(scratch_.path(), {"estimate", "fra"}), (std::set<std::string>{""}));
}

TEST(Completion, IsReadByItsShell) {
  const TemporaryFolder scratch;
  int shells = 0;
  for (const std::string shell : {"bash", "zsh", "fish"}) {
    const auto said = run_flowdlo(scratch.path(), {"completion", shell});
    EXPECT_EQ(said.exit_code, 0);
    EXPECT_THAT(said.out, HasSubstr("estimate"));
    if (!has_program(shell)) continue;
    ++shells;
    const auto file = scratch.path() / ("script." + shell);
    test::write_text(file, said.out);
    EXPECT_EQ(std::system((shell + " -n '" + file.string() + "'").c_str()), 0) << shell;
  }
  if (shells == 0) GTEST_SKIP() << "no shell is installed";
}

TEST(Manual, HasAPageForEveryCommandWithEveryOption) {
  const TemporaryFolder scratch;
  const auto folder = scratch.path() / "man";
  ASSERT_EQ(run_flowdlo(scratch.path(), {"manual", folder.string()}).exit_code, 0);
  for (const char* command : {"estimate", "mask", "devices", "weights", "bench", "eval"}) {
    const auto page = test::read_text(folder / ("flowdlo-" + std::string(command) + ".1"));
    EXPECT_THAT(page, ::testing::StartsWith(".TH "));
    for (const auto& option : options_of(scratch.path(), command)) {
      EXPECT_THAT(std::regex_replace(page, std::regex(R"(\\-)"), "-"), HasSubstr("fB" + option))
          << command;
    }
  }
  EXPECT_THAT(test::read_text(folder / "flowdlo.1"), HasSubstr("flowdlo\\-weights"));
  EXPECT_THAT(test::read_text(folder / "flowdlo-weights.1"), HasSubstr("flowdlo\\-weights\\-info"));
}

TEST(Manual, HasNoWarningsOfGroff) {
  if (!has_program("groff")) GTEST_SKIP() << "groff is not installed";
  const TemporaryFolder scratch;
  ASSERT_EQ(run_flowdlo(scratch.path(), {"manual", scratch.path().string()}).exit_code, 0);
  const auto said = scratch.path() / "said.txt";
  for (const auto& entry : fs::directory_iterator(scratch.path())) {
    if (entry.path().extension() != ".1") continue;
    const auto line = "groff -man -ww -Tutf8 '" + entry.path().string() + "' 2> '" + said.string() +
                      "' > /dev/null";
    EXPECT_EQ(std::system(line.c_str()), 0);
    EXPECT_EQ(test::read_text(said), "") << entry.path();
  }
}

TEST(Manual, SaysWhereItCannotBeWritten) {
  const TemporaryFolder scratch;
  test::write_text(scratch.path() / "file", "");
  const auto outcome = run_flowdlo(scratch.path(), {"manual", (scratch.path() / "file").string()});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("file"));
}

TEST(MistypedCommand, IsNamedWithTheNearestOne) {
  const TemporaryFolder scratch;
  const auto meant = [&](const std::string& word) {
    const auto outcome = run_flowdlo(scratch.path(), {word, "frame"});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("got \"" + word + "\""));
    return outcome.err;
  };
  EXPECT_THAT(meant("estimat"), HasSubstr("did you mean estimate?"));
  EXPECT_THAT(meant("msak"), HasSubstr("did you mean mask?"));
  EXPECT_THAT(meant("dev"), HasSubstr("did you mean devices?"));
  EXPECT_THAT(meant("fly"), Not(HasSubstr("did you mean")));
}

TEST(MistypedCommand, OfACommandIsNamedAsWell) {
  const TemporaryFolder scratch;
  const auto mistyped = run_flowdlo(scratch.path(), {"weights", "inf", "robust.fdw"});
  EXPECT_EQ(mistyped.exit_code, 2);
  EXPECT_THAT(mistyped.err, HasSubstr("flowdlo weights: expected a command"));
  EXPECT_THAT(mistyped.err, HasSubstr("got \"inf\"; did you mean info?"));
  const auto without = run_flowdlo(scratch.path(), {"weights", "--help", "inf"});
  EXPECT_EQ(without.exit_code, 0);
}

TEST(Help, ShowsNamesOfChoicesAndTakesNoNumbers) {
  const TemporaryFolder scratch;
  for (const char* command : {"estimate", "bench", "eval", "synth", "mask"}) {
    EXPECT_THAT(run_flowdlo(scratch.path(), {command, "--help"}).out, Not(HasSubstr("->")));
  }
  EXPECT_THAT(run_flowdlo(scratch.path(), {"estimate", "--help"}).out, HasSubstr("auto|full|fast"));
  const auto number = run_flowdlo(scratch.path(), {"bench", "--quality", "1"});
  EXPECT_EQ(number.exit_code, 2);
  EXPECT_THAT(number.err, HasSubstr("expected auto|full|fast, got \"1\""));
}

}  // namespace
}  // namespace flowdlo
