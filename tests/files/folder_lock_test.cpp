#include "files/folder_lock.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <optional>
#include <thread>
#include <vector>

#include "files/failing_calls.hpp"
#include "frame/temporary_folder.hpp"

namespace flowdlo::files {
namespace {

namespace fs = std::filesystem;
using test::FailingCalls;
using testing::HasSubstr;

/// Of a file system that locks folders, one that locks files alone, and one that locks nothing.
enum class Locks { kFolders, kFiles, kNone };

class Locking : public FailingCalls {
 public:
  explicit Locking(Locks locks, bool sleeps = true) : locks_(locks), sleeps_(sleeps) {
    if (locks != Locks::kFolders) without_folder_locks();
  }
  int flock(int file, int operation) const override {
    if (locks_ != Locks::kNone) return FailingCalls::flock(file, operation);
    errno = ENOLCK;
    return -1;
  }
  void sleep_ms(int milliseconds) const override {
    if (sleeps_) SystemCalls::sleep_ms(milliseconds);
  }

 private:
  Locks locks_;
  bool sleeps_;
};

class FolderLockOf : public testing::TestWithParam<Locks> {};

TEST_P(FolderLockOf, IsHeldByOneAtATimeAndLeavesNothing) {
  const test::TemporaryFolder scratch;
  std::atomic<int> inside = 0;
  std::atomic<int> most = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      const Locking calls(GetParam());
      const auto folder = Folder::open(scratch.path(), calls);
      for (int round = 0; round < 200; ++round) {
        const auto lock = FolderLock::take(*folder);
        ASSERT_TRUE(lock) << lock.error().message;
        most = std::max<int>(most, ++inside);
        std::this_thread::yield();
        --inside;
      }
    });
  }
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(most, 1);
  EXPECT_TRUE(fs::is_empty(scratch.path()));
}

INSTANTIATE_TEST_SUITE_P(FolderLock, FolderLockOf, testing::Values(Locks::kFolders, Locks::kFiles));

TEST(FolderLock, OfAFileSystemWithoutLocksLetsEveryoneIn) {
  const test::TemporaryFolder scratch;
  const Locking calls(Locks::kNone);
  const auto folder = Folder::open(scratch.path(), calls);
  const auto one = FolderLock::take(*folder);
  const auto other = FolderLock::take(*folder);
  EXPECT_TRUE(one);
  EXPECT_TRUE(other);
  EXPECT_TRUE(fs::is_empty(scratch.path()));
}

TEST(FolderLock, ThatIsNotGivenBackIsNotWaitedForForEver) {
  for (const Locks locks : {Locks::kFolders, Locks::kFiles}) {
    const test::TemporaryFolder scratch;
    const Locking calls(locks, /*sleeps=*/false);
    const auto folder = Folder::open(scratch.path(), calls);
    const auto held = FolderLock::take(*folder);
    ASSERT_TRUE(held);
    const auto refused = FolderLock::take(*folder);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::kIo);
    EXPECT_THAT(refused.error().message, HasSubstr("another process"));
  }
}

}  // namespace
}  // namespace flowdlo::files
