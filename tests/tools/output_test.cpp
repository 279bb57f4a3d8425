// Where the command's output goes: devices, pipes, full disks, and names that hold control
// characters.
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <thread>

#include "files/device_node.hpp"
#include "frame/temporary_folder.hpp"
#include "tools/program.hpp"

namespace flowdlo {
namespace {

namespace fs = std::filesystem;
using test::read_text;
using test::run_estimate;
using test::run_flowdlo;
using test::TemporaryFolder;
using testing::HasSubstr;
using testing::Not;

/// Exit code of a line of the shell; its standard error goes to `scratch`/err.
int shell(const fs::path& scratch, const std::string& line) {
  const auto whole =
      std::string(FLOWDLO_COMMAND) + " " + line + " 2> '" + (scratch / "err").string() + "'";
  const int status = std::system(whole.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

class FullOutput : public testing::TestWithParam<const char*> {};

TEST_P(FullOutput, EndsWithOneAndASentence) {
  const TemporaryFolder scratch;
  EXPECT_EQ(shell(scratch.path(), std::string(GetParam()) + " > /dev/full"), 1);
  EXPECT_THAT(read_text(scratch.path() / "err"), HasSubstr("standard output cannot be written"));
}

INSTANTIATE_TEST_SUITE_P(Output, FullOutput,
                         testing::Values("--version", "--help", "estimate --help", "devices --json",
                                         "weights info " FLOWDLO_WEIGHTS,
                                         "bench --frames 1 --draws 1 --steps 1 --device cpu"));

TEST(Output, OfAnEstimateThatCannotBePrintedIsStillOnDisk) {
  const TemporaryFolder scratch;
  const auto frame = test::write_frame(scratch.path());
  const auto out = scratch.path() / "out";
  EXPECT_EQ(shell(scratch.path(), "estimate '" + frame.string() + "' --out '" + out.string() +
                                      "' --device cpu --draws 1 --steps 1 > /dev/full"),
            1);
  EXPECT_TRUE(fs::exists(out / "rope" / "estimate.json"));
}

TEST(Output, StandardErrorThatIsFullEndsNothingEarly) {
  const TemporaryFolder scratch;
  const auto line = std::string(FLOWDLO_COMMAND) + " weights info none.fdw 2> /dev/full";
  const int status = std::system(line.c_str());
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1);
}

TEST(Output, ExportIntoADeviceLeavesItOne) {
  const TemporaryFolder scratch;
  const auto null = scratch.path() / "null";
  const auto full = scratch.path() / "full";
  if (!test::make_device(null, test::kNull) || !test::make_device(full, test::kFull)) {
    GTEST_SKIP() << "this user may make no devices";
  }
  const auto export_to = [&](const fs::path& file) {
    return run_flowdlo(scratch.path(), {"weights", "export", FLOWDLO_WEIGHTS, file.string()});
  };
  EXPECT_EQ(export_to(null).exit_code, 0);
  struct stat status {};
  ASSERT_EQ(::stat(null.c_str(), &status), 0);
  EXPECT_TRUE(S_ISCHR(status.st_mode));
  EXPECT_EQ(export_to(full).exit_code, 1);
}

TEST(Output, ExportIntoAPipeArrivesWhole) {
  const TemporaryFolder scratch;
  const auto pipe = scratch.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::string got;
  std::thread reader([&] { got = read_text(pipe); });
  const auto outcome =
      run_flowdlo(scratch.path(), {"weights", "export", FLOWDLO_WEIGHTS, pipe.string()});
  reader.join();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto file = (scratch.path() / "file").string();
  ASSERT_EQ(run_flowdlo(scratch.path(), {"weights", "export", FLOWDLO_WEIGHTS, file}).exit_code, 0);
  EXPECT_EQ(got, read_text(file));
}

TEST(Output, ExportOverALinkKeepsTheLinkAndTheMode) {
  const TemporaryFolder scratch;
  const auto target = scratch.path() / "target";
  test::write_text(target, "old");
  ASSERT_EQ(::chmod(target.c_str(), 0600), 0);
  fs::create_symlink("target", scratch.path() / "link");
  const auto link = (scratch.path() / "link").string();
  ASSERT_EQ(run_flowdlo(scratch.path(), {"weights", "export", FLOWDLO_WEIGHTS, link}).exit_code, 0);
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_GT(fs::file_size(target), 1000);
  struct stat status {};
  ASSERT_EQ(::stat(target.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST(Output, ControlCharactersInNamesAreWrittenOut) {
  const TemporaryFolder scratch;
  const std::string name = "rope\x1B[2J\nall well: ok";
  const auto frame = test::write_frame(scratch.path(), name);
  const auto good = run_estimate(scratch.path(), {frame.string()});
  ASSERT_EQ(good.exit_code, 0) << good.err;
  EXPECT_THAT(good.out, HasSubstr("rope\\x1b[2J\\x0aall well: ok: "));
  EXPECT_THAT(good.out, Not(HasSubstr("\x1B")));

  fs::remove(frame / "depth.png");
  const auto bad = run_estimate(scratch.path(), {frame.string()});
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_THAT(bad.err, HasSubstr("\\x1b[2J\\x0aall well: ok/depth.png"));
  EXPECT_THAT(bad.err, Not(HasSubstr("\x1B")));
  EXPECT_THAT(bad.err, Not(HasSubstr("\nall well: ok")));
}

TEST(Output, ControlCharactersInArgumentsAreWrittenOut) {
  const TemporaryFolder scratch;
  const auto outcome = run_flowdlo(scratch.path(), {"weights", "info", "no\x1B]0;title\x07.fdw"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("no\\x1b]0;title\\x07.fdw"));
  const auto usage = run_flowdlo(scratch.path(), {"fly\x1B[31m"});
  EXPECT_EQ(usage.exit_code, 2);
  EXPECT_THAT(usage.err, Not(HasSubstr("\x1B")));
}

TEST(Output, OfTwoRunsIntoOneFolderIsThatOfOne) {
  const TemporaryFolder scratch;
  const auto frame = test::write_frame(scratch.path());
  const auto run = [&](const char* draws) {
    return std::string(FLOWDLO_COMMAND) + " estimate '" + frame.string() + "' --out '" +
           (scratch.path() / "out").string() + "' --device cpu --steps 1 --draws " + draws +
           " --quiet --weights " FLOWDLO_WEIGHTS;
  };
  const std::string both = run("1") + " & one=$!; " + run("2") + " && wait $one";
  for (int round = 0; round < 3; ++round) {
    ASSERT_EQ(std::system(both.c_str()), 0);
    EXPECT_EQ(test::estimate_json_of(scratch.path(), "rope")["status"], "ok");
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(test::results(scratch.path(), "rope"))) {
      files += entry.exists() ? 1 : 0;
    }
    EXPECT_EQ(files, 3) << "and nothing is left over";
  }
}

/// No file may grow: every write fails as on a full disk, and what is only removed needs no room.
TEST(Output, OfARunThatCanWriteNothingIsNotThatOfAnEarlierOne) {
  const TemporaryFolder scratch;
  const auto frame = test::write_frame(scratch.path());
  ASSERT_EQ(run_estimate(scratch.path(), {frame.string()}).exit_code, 0);
  ASSERT_EQ(test::estimate_json_of(scratch.path(), "rope")["status"], "ok");
  const auto line = std::string("trap '' XFSZ; ulimit -f 0; exec ") + FLOWDLO_COMMAND +
                    " estimate '" + frame.string() + "' --out '" +
                    (scratch.path() / "out").string() +
                    "' --device cpu --steps 1 --draws 1 --quiet --weights " FLOWDLO_WEIGHTS;
  const int status = std::system(line.c_str());
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1);
  for (const char* name : {"estimate.json", "centerline.csv", "overlay.png"}) {
    EXPECT_FALSE(fs::exists(test::results(scratch.path(), "rope") / name)) << name;
  }
}

TEST(Output, ABenchsFiguresGoThroughLinksAndIntoDevices) {
  const TemporaryFolder scratch;
  const auto frame = test::write_frame(scratch.path());
  const auto bench_to = [&](const fs::path& file) {
    return run_flowdlo(scratch.path(),
                       {"bench", frame.string(), "--frames", "1", "--draws", "1", "--steps", "1",
                        "--device", "cpu", "--weights", FLOWDLO_WEIGHTS, "--json", file.string()})
        .exit_code;
  };
  test::write_text(scratch.path() / "target", "old");
  ASSERT_EQ(::chmod((scratch.path() / "target").c_str(), 0600), 0);
  fs::create_symlink("target", scratch.path() / "link");
  EXPECT_EQ(bench_to(scratch.path() / "link"), 0);
  EXPECT_TRUE(fs::is_symlink(scratch.path() / "link"));
  EXPECT_EQ(read_text(scratch.path() / "target").front(), '{');
  struct stat status {};
  ASSERT_EQ(::stat((scratch.path() / "target").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);

  const auto null = scratch.path() / "null";
  if (!test::make_device(null, test::kNull)) GTEST_SKIP() << "this user may make no devices";
  EXPECT_EQ(bench_to(null), 0);
  ASSERT_EQ(::stat(null.c_str(), &status), 0);
  EXPECT_TRUE(S_ISCHR(status.st_mode));
}

}  // namespace
}  // namespace flowdlo
