#include "files/whole_file.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <thread>

#include "files/device_node.hpp"
#include "files/failing_calls.hpp"
#include "frame/temporary_folder.hpp"

namespace flowdlo::files {
namespace {

namespace fs = std::filesystem;
using test::FailingCalls;
using test::Fault;
using test::read_text;
using testing::HasSubstr;

class WholeFile : public testing::Test {
 protected:
  [[nodiscard]] fs::path path(const char* name) const { return scratch_.path() / name; }
  [[nodiscard]] std::ptrdiff_t entries() const {
    return std::distance(fs::directory_iterator(scratch_.path()), fs::directory_iterator());
  }
  static Result<void> write(const fs::path& file, std::string_view text = "new",
                            const SystemCalls& calls = kernel()) {
    return write_file(file, text, Durability::kSynced, calls);
  }
  static mode_t mode_of(const fs::path& file) {
    struct stat status {};
    EXPECT_EQ(::lstat(file.c_str(), &status), 0);
    return status.st_mode;
  }

  test::TemporaryFolder scratch_;
};

TEST_F(WholeFile, AppearsWithItsContentAlone) {
  ASSERT_TRUE(write(path("a")));
  EXPECT_EQ(read_text(path("a")), "new");
  EXPECT_EQ(entries(), 1);
}

TEST_F(WholeFile, OfAnotherFilesPlaceKeepsItsMode) {
  for (const mode_t mode : {0600U, 0640U, 0755U}) {
    test::write_text(path("a"), "old");
    ASSERT_EQ(::chmod(path("a").c_str(), mode), 0);
    ASSERT_TRUE(write(path("a")));
    EXPECT_EQ(mode_of(path("a")), S_IFREG | mode);
  }
}

TEST_F(WholeFile, LinksStayAndTheirTargetsChange) {
  fs::create_directories(path("sub"));
  test::write_text(path("sub") / "target", "old");
  fs::create_symlink("sub/target", path("second"));
  fs::create_symlink("second", path("first"));
  ASSERT_TRUE(write(path("first")));
  EXPECT_TRUE(fs::is_symlink(path("first")));
  EXPECT_TRUE(fs::is_symlink(path("second")));
  EXPECT_EQ(read_text(path("sub") / "target"), "new");
  EXPECT_EQ(std::distance(fs::directory_iterator(path("sub")), {}), 1);
}

TEST_F(WholeFile, LinkToNothingYetMakesItsTarget) {
  fs::create_symlink("target", path("link"));
  ASSERT_TRUE(write(path("link")));
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(read_text(path("target")), "new");
}

TEST_F(WholeFile, LinksInARingAreAnError) {
  fs::create_symlink("b", path("a"));
  fs::create_symlink("a", path("b"));
  EXPECT_FALSE(write(path("a")));
}

TEST_F(WholeFile, DeviceIsWrittenIntoAndStays) {
  if (!test::make_device(path("null"), test::kNull) ||
      !test::make_device(path("full"), test::kFull)) {
    GTEST_SKIP() << "this user may make no devices";
  }
  ASSERT_TRUE(write(path("null")));
  EXPECT_TRUE(S_ISCHR(mode_of(path("null"))));
  const auto full = write(path("full"));
  ASSERT_FALSE(full);
  EXPECT_THAT(full.error().message, HasSubstr("full: cannot be written: No space left"));
  fs::create_symlink("null", path("link"));
  ASSERT_TRUE(write(path("link")));
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_TRUE(S_ISCHR(mode_of(path("null"))));
  EXPECT_EQ(entries(), 3);
}

TEST_F(WholeFile, PipeIsWrittenIntoAlsoBeyondWhatItHolds) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  std::string long_text(1 << 20, 'x');
  std::string got;
  std::thread reader([&] { got = read_text(path("pipe")); });
  const auto written = write(path("pipe"), long_text);
  reader.join();
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_EQ(got, long_text);
  EXPECT_TRUE(S_ISFIFO(mode_of(path("pipe"))));
  EXPECT_EQ(entries(), 1);
}

TEST_F(WholeFile, PipeWithoutAReaderIsAnErrorInTheEnd) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  const auto written = write(path("pipe"), "new", FailingCalls());  // whose sleeps take no time
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, HasSubstr("start its reader"));
}

TEST_F(WholeFile, ReaderThatGoesAwayIsAnErrorAndNoSignal) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  std::thread reader([&] {
    const int end = ::open(path("pipe").c_str(), O_RDONLY);
    char byte = 0;
    EXPECT_EQ(::read(end, &byte, 1), 1);
    ::close(end);
  });
  const auto written = write(path("pipe"), std::string(1 << 20, 'x'));
  reader.join();
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, HasSubstr("Broken pipe"));
}

TEST_F(WholeFile, ThatIsOurOwnOutputIsAddedTo) {
  const int before = ::dup(STDOUT_FILENO);
  const int report = ::open(path("report").c_str(), O_WRONLY | O_CREAT, 0600);
  ASSERT_EQ(::dup2(report, STDOUT_FILENO), STDOUT_FILENO);
  EXPECT_EQ(::write(STDOUT_FILENO, "above\n", 6), 6);
  const auto written = write("/dev/stdout");
  ASSERT_EQ(::dup2(before, STDOUT_FILENO), STDOUT_FILENO);
  ::close(before);
  ::close(report);
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_EQ(read_text(path("report")), "above\nnew");
}

TEST_F(WholeFile, FolderInItsPlaceOrNoFolderAboveItIsAnError) {
  fs::create_directories(path("a") / "full");
  for (const fs::path& file : {path("a"), path("none") / "b", fs::path(), scratch_.path() / ""}) {
    const auto written = write(file);
    ASSERT_FALSE(written) << file;
    EXPECT_EQ(written.error().code, ErrorCode::kIo);
  }
  EXPECT_EQ(entries(), 1);
}

class FailingWholeFile : public WholeFile, public testing::WithParamInterface<Fault> {};

TEST_P(FailingWholeFile, LeavesTheOldContentOrTheNew) {
  test::write_text(path("target"), "old");
  fs::create_symlink("target", path("link"));
  const FailingCalls counting;
  ASSERT_TRUE(write(path("link"), "new", counting));
  int kept = 0;
  for (int at = 0; at < counting.count(); ++at) {
    test::write_text(path("target"), "old");
    Fault fault = GetParam();
    fault.at = at;
    SCOPED_TRACE(testing::Message() << fault);
    const auto written = write(path("link"), "new", FailingCalls(fault));
    const auto text = read_text(path("target"));
    ASSERT_TRUE(text == "old" || text == "new") << text;
    ASSERT_TRUE(fs::is_symlink(path("link")));
    ASSERT_TRUE(!written || text == "new");
    kept += text == "old" ? 1 : 0;
    ASSERT_TRUE(fault.kind != Fault::Kind::kOnce || entries() <= 3) << entries();
  }
  const bool harmless = GetParam().kind == Fault::Kind::kShort || GetParam().code == EINTR;
  EXPECT_EQ(kept == 0, harmless);
}

INSTANTIATE_TEST_SUITE_P(EveryCall, FailingWholeFile, testing::ValuesIn(test::faults_of_a_call()));

}  // namespace
}  // namespace flowdlo::files
