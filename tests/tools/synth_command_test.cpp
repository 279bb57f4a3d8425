// flowdlo synth: frame folders that the reader gives back bit for bit, whole or not at all.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "flowdlo/frame_folder.hpp"
#include "frame/temporary_folder.hpp"
#include "synth/synthetic_frame.hpp"
#include "tools/program.hpp"

namespace flowdlo {
namespace {

namespace fs = std::filesystem;
using synth::Part;
using synth::Split;
using test::run_flowdlo;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

/// Whether `process` becomes the program `name` within ten seconds.
bool becomes(pid_t process, const std::string& name) {
  const auto link = fs::path("/proc") / std::to_string(process) / "exe";
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (std::chrono::steady_clock::now() < end) {
    std::error_code ignored;
    if (fs::read_symlink(link, ignored).filename() == name) return true;
    ::usleep(10000);
  }
  return false;
}

TEST(SynthCommand, IsTheProcessThatWasStartedAndEndsByCtrlC) {
  const TemporaryFolder scratch;
  const std::string out = (scratch.path() / "set").string();
  const pid_t process = ::fork();
  ASSERT_GE(process, 0);
  if (process == 0) {
    ::execl(FLOWDLO_COMMAND, FLOWDLO_COMMAND, "synth", out.c_str(), "--count", "1000000", "--quiet",
            nullptr);
    ::_exit(127);
  }
  EXPECT_TRUE(becomes(process, "flowdlo-lab"));
  ::kill(process, SIGINT);
  int status = 0;
  ASSERT_EQ(::waitpid(process, &status, 0), process);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGINT);
}

TEST(SynthCommand, WritesTheFramesThatMakeFrameMakes) {
  const TemporaryFolder scratch;
  const auto out = scratch.path() / "set";
  const auto outcome = run_flowdlo(scratch.path(), {"synth", out.string(), "--split", "thesis",
                                                    "--part", "validation", "--count", "2"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("2 frames of the thesis split's validation part"));
  EXPECT_THAT(names_in(out), ElementsAre("000000_C", "000001_C"));

  const auto made = synth::make_frame(Split::kThesis, Part::kValidation, 0, 1);
  const auto read = load_frame_folder(out / "000001_C");
  ASSERT_TRUE(made);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->name, made->folder.name);
  EXPECT_EQ(read->depth_m, made->folder.depth_m);
  EXPECT_EQ(read->mask, made->folder.mask);
  EXPECT_EQ(read->color_bgr, made->folder.color_bgr);
  EXPECT_EQ(read->intrinsics.fx, made->folder.intrinsics.fx);
  EXPECT_EQ(read->intrinsics.cy, made->folder.intrinsics.cy);
  ASSERT_TRUE(read->truth);
  for (std::size_t i = 0; i < kNodes; ++i) {
    EXPECT_NEAR((*read->truth)[i].x, made->truth()[i].x, 1e-6);
    EXPECT_NEAR((*read->truth)[i].z, made->truth()[i].z, 1e-6);
  }
  EXPECT_EQ(test::read_text(out / "000001_C" / "meta.json"), synth::meta_json(made->meta));
}

TEST(SynthCommand, WideFramesSurviveTheRoundTripToo) {
  const TemporaryFolder scratch;
  const auto out = scratch.path() / "set";
  ASSERT_EQ(run_flowdlo(scratch.path(), {"synth", out.string(), "--first", "3", "--count", "2",
                                         "--seed", "5", "--quiet"})
                .exit_code,
            0);
  for (std::uint64_t index = 3; index < 5; ++index) {
    const auto made = synth::make_frame(Split::kWide, Part::kTraining, 5, index);
    ASSERT_TRUE(made);
    const auto read = load_frame_folder(out / made->folder.name);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->depth_m, made->folder.depth_m);
    EXPECT_EQ(read->mask, made->folder.mask);
  }
}

TEST(SynthCommand, WhatIsOfRenderedScenesAloneIsRefusedOfDrawnOnes) {
  const TemporaryFolder scratch;
  for (const char* const flag : {"--cords", "--matched"}) {
    const auto outcome = run_flowdlo(scratch.path(), {"synth", (scratch.path() / "set").string(),
                                                      "--split", "drawn", "--count", "1", flag});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, HasSubstr(std::string(flag) + ": expected a rendered split"));
    EXPECT_FALSE(std::filesystem::exists(scratch.path() / "set"));
  }
}

TEST(SynthCommand, CanBeStartedAgain) {
  const TemporaryFolder scratch;
  const auto out = (scratch.path() / "set").string();
  ASSERT_EQ(run_flowdlo(scratch.path(), {"synth", out, "--count", "2"}).exit_code, 0);
  const auto again = run_flowdlo(scratch.path(), {"synth", out, "--count", "3"});

  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("3 frames"));
  EXPECT_THAT(again.out, HasSubstr("2 of them were there already"));
  EXPECT_EQ(names_in(out).size(), 3U);
}

TEST(SynthCommand, RemovesWhatAnEndedRunLeftHalfDone) {
  const TemporaryFolder scratch;
  const auto out = scratch.path() / "set";
  fs::create_directories(out / ".unfinished-2147483646" / "000000_coil");
  ASSERT_EQ(run_flowdlo(scratch.path(), {"synth", out.string(), "--count", "1"}).exit_code, 0);

  EXPECT_EQ(names_in(out).size(), 1U);
  EXPECT_FALSE(fs::exists(out / ".unfinished-2147483646"));
}

TEST(SynthCommand, DoesNotMixSets) {
  const TemporaryFolder scratch;
  const auto out = (scratch.path() / "set").string();
  const std::vector<std::string> thesis = {"synth",      out, "--split", "thesis",
                                           "--scenario", "S", "--count", "1"};
  ASSERT_EQ(run_flowdlo(scratch.path(), thesis).exit_code, 0);
  auto other = thesis;
  other.insert(other.end(), {"--seed", "1"});
  const auto outcome = run_flowdlo(scratch.path(), other);

  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("found another; choose another folder"));

  auto cords = thesis;
  cords.emplace_back("--cords");
  const auto with_cords = run_flowdlo(scratch.path(), cords);
  EXPECT_EQ(with_cords.exit_code, 2);
  EXPECT_THAT(with_cords.err, HasSubstr("with cords), found another"));
}

TEST(SynthCommand, SeveralFramesOfOneSceneStandBesideEachOther) {
  const TemporaryFolder scratch;
  const auto out = scratch.path() / "set";
  ASSERT_EQ(run_flowdlo(scratch.path(), {"synth", out.string(), "--split", "thesis", "--count", "1",
                                         "--frames-per-scene", "3"})
                .exit_code,
            0);
  EXPECT_THAT(names_in(out), ElementsAre("000000_C", "000000_C_001", "000000_C_002"));
}

TEST(SynthCommand, DrawsAContactSheetWithoutADataSet) {
  const TemporaryFolder scratch;
  const auto sheet = scratch.path() / "sheet.png";
  const auto outcome = run_flowdlo(scratch.path(), {"synth", "--scenario", "coil", "--count", "2",
                                                    "--contact-sheet", sheet.string()});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_GT(fs::file_size(sheet), 10000U);
}

class WrongSynth : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(WrongSynth, EndsWithTwoAndASentence) {
  const TemporaryFolder scratch;
  auto arguments = GetParam();
  for (auto& argument : arguments) {
    if (argument == "OUT") argument = (scratch.path() / "set").string();
  }
  const auto outcome = run_flowdlo(scratch.path(), arguments);
  EXPECT_EQ(outcome.exit_code, 2) << outcome.out << outcome.err;
  EXPECT_NE(outcome.err, "");
  EXPECT_FALSE(fs::exists(scratch.path() / "set"));
}

using Arguments = std::vector<std::string>;
INSTANTIATE_TEST_SUITE_P(
    SynthCommand, WrongSynth,
    testing::Values(Arguments{"synth"}, Arguments{"synth", "OUT", "--split", "narrow"},
                    Arguments{"synth", "OUT", "--part", "test"},
                    Arguments{"synth", "OUT", "--count", "0"},
                    Arguments{"synth", "OUT", "--seed", "-1"},
                    Arguments{"synth", "OUT", "--first", "18446744073709551616"},
                    Arguments{"synth", "OUT", "--scenario", "knot"},
                    Arguments{"synth", "OUT", "--frames-per-scene", "0"},
                    Arguments{"synth", "OUT", "--split", "thesis", "--count", "235"},
                    Arguments{"synth", "OUT", "--split", "thesis", "--scenario", "straight",
                              "--count", "11"}));

TEST(SynthCommand, AFileInThePlaceOfOutIsAnError) {
  const TemporaryFolder scratch;
  test::write_text(scratch.path() / "set", "no folder");
  const auto outcome =
      run_flowdlo(scratch.path(), {"synth", (scratch.path() / "set").string(), "--count", "1"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("cannot be made"));
}

}  // namespace
}  // namespace flowdlo
