#include "files/regular_file.hpp"

#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>

#include "files/failing_calls.hpp"
#include "frame/temporary_folder.hpp"

namespace flowdlo::files {
namespace {

namespace fs = std::filesystem;
using test::FailingCalls;
using test::Fault;
using testing::HasSubstr;

std::string fault_of(const fs::path& file) {
  const auto text = read_text(file, 100);
  EXPECT_FALSE(text);
  if (text) return "";
  EXPECT_EQ(text.error().code, ErrorCode::kIo);
  return text.error().message;
}

TEST(RegularFile, IsReadWhole) {
  const test::TemporaryFolder folder;
  test::write_text(folder.path() / "a", std::string("b\0c", 3));
  const auto text = read_text(folder.path() / "a", 3);
  ASSERT_TRUE(text) << text.error().message;
  EXPECT_EQ(*text, std::string("b\0c", 3));
}

TEST(RegularFile, OfNoBytesIsRead) {
  const test::TemporaryFolder folder;
  test::write_text(folder.path() / "a", "");
  const auto bytes = read_file(folder.path() / "a", 3);
  ASSERT_TRUE(bytes);
  EXPECT_EQ(bytes->size, 0);
}

TEST(RegularFile, OverTheBoundIsRefusedBeforeItIsRead) {
  const test::TemporaryFolder folder;
  test::write_text(folder.path() / "a", "four");
  fs::resize_file(folder.path() / "a", std::uintmax_t{1} << 40U);  // a hole
  const auto text = read_text(folder.path() / "a", 3);
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(text.error().message, HasSubstr("expected at most 3 bytes, got 1099511627776"));
}

TEST(RegularFile, PipesDevicesSocketsAndFoldersAreRefusedAtOnce) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(fault_of(folder.path() / "pipe"), HasSubstr("got a pipe"));
  EXPECT_THAT(fault_of("/dev/zero"), HasSubstr("got a device"));
  EXPECT_THAT(fault_of(folder.path()), HasSubstr("got a folder"));
  sockaddr_un address{AF_UNIX, "flowdlo_socket"};
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(::chdir(folder.path().c_str()), 0);
  ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  EXPECT_THAT(fault_of("flowdlo_socket"), HasSubstr("expected a file"));
  ::close(socket);
}

TEST(RegularFile, ThatIsMissingSaysSo) {
  EXPECT_THAT(fault_of("no/such/file"), HasSubstr("no/such/file: expected a file, found none"));
}

/// A file that has other bytes when it is read than when it was opened.
class Changing : public FailingCalls {
 public:
  explicit Changing(off_t difference) : difference_(difference) {}
  int fstat(int file, struct stat& status) const override {
    const int got = FailingCalls::fstat(file, status);
    status.st_size += difference_;
    return got;
  }

 private:
  off_t difference_;
};

TEST(RegularFile, ThatGrowsOrShrinksMeanwhileIsRefused) {
  const test::TemporaryFolder folder;
  test::write_text(folder.path() / "a", "four");
  for (const off_t difference : {-1, 1}) {
    const auto text = read_text(folder.path() / "a", 100, Changing(difference));
    ASSERT_FALSE(text);
    EXPECT_THAT(text.error().message, HasSubstr("changes while it is read"));
  }
}

TEST(RegularFile, CallsThatFailGiveTheReasonAndTheRemedy) {
  const test::TemporaryFolder folder;
  test::write_text(folder.path() / "a", "four");
  const FailingCalls counting;
  ASSERT_TRUE(read_text(folder.path() / "a", 100, counting));
  ASSERT_GE(counting.count(), 4);
  for (int at = 0; at < counting.count() - 1; ++at) {  // the last closes what was read
    const auto text =
        read_text(folder.path() / "a", 100, FailingCalls({Fault::Kind::kOnce, EMFILE, at}));
    ASSERT_FALSE(text) << at;
    EXPECT_THAT(text.error().message, HasSubstr("Too many open files; close files")) << at;
    EXPECT_TRUE(read_text(folder.path() / "a", 100, FailingCalls({Fault::Kind::kOnce, EINTR, at})));
  }
}

TEST(RegularFile, InterruptionsWithoutEndAreAFailure) {
  const test::TemporaryFolder folder;
  test::write_text(folder.path() / "a", "four");
  EXPECT_FALSE(
      read_text(folder.path() / "a", 100, FailingCalls({Fault::Kind::kForGood, EINTR, 0})));
}

}  // namespace
}  // namespace flowdlo::files
