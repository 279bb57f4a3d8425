#include "files/temporary_file.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <ctime>
#include <set>

#include "files/failing_calls.hpp"
#include "frame/temporary_folder.hpp"

namespace flowdlo::files {
namespace {

namespace fs = std::filesystem;
using test::FailingCalls;
using test::Fault;

constexpr auto kSingle = TemporaryKind::kSingle;
constexpr auto kPart = TemporaryKind::kPart;

/// A clock and dice of the test's own.
class Arranged : public FailingCalls {
 public:
  int random(std::uint64_t& bits) const override {
    bits = next_++ / 2;  // each number twice
    return 0;
  }
  [[nodiscard]] std::int64_t now_s() const override { return FailingCalls::now_s() + later_s; }

  std::int64_t later_s = 0;

 private:
  mutable std::uint64_t next_ = 0;
};

class TemporaryFileTest : public testing::Test {
 protected:
  [[nodiscard]] std::set<std::string> names() const {
    std::set<std::string> found;
    for (const auto& entry : fs::directory_iterator(scratch_.path())) {
      found.insert(entry.path().filename().string());
    }
    return found;
  }
  [[nodiscard]] Folder folder(const SystemCalls& calls = kernel()) const {
    return *Folder::open(scratch_.path(), calls);
  }

  test::TemporaryFolder scratch_;
};

TEST_F(TemporaryFileTest, NamesCannotBeGuessedAndAreOurs) {
  const Folder held = folder();
  std::set<std::string> names;
  for (int i = 0; i < 100; ++i) {
    const auto file = TemporaryFile::create(held, kSingle, "a");
    ASSERT_TRUE(file);
    EXPECT_TRUE(is_temporary(file->name(), kSingle));
    EXPECT_FALSE(is_temporary(file->name(), kPart));
    names.insert(file->name());
  }
  EXPECT_EQ(names.size(), 100);
  EXPECT_TRUE(this->names().empty()) << "each went with its owner";
}

TEST_F(TemporaryFileTest, NameThatIsTakenIsNotOpened) {
  const Arranged calls;
  const Folder held = folder(calls);
  const auto victim = scratch_.path() / "victim";
  test::write_text(victim, "precious");
  fs::create_symlink(victim, scratch_.path() / ".flowdlo-0000000000000000.tmp");
  auto file = TemporaryFile::create(held, kSingle, "a");
  ASSERT_TRUE(file);
  EXPECT_EQ(file->name(), ".flowdlo-0000000000000001.tmp");
  EXPECT_EQ(test::read_text(victim), "precious");
}

TEST_F(TemporaryFileTest, FolderThatIsMovedIsStillTheOneThatIsWritten) {
  const auto before = scratch_.path() / "before";
  fs::create_directory(before);
  const auto held = Folder::open(before);
  ASSERT_TRUE(held);
  auto file = TemporaryFile::create(*held, kSingle, "a");
  ASSERT_TRUE(file);
  fs::rename(before, scratch_.path() / "after");
  fs::create_directory(before);  // somebody else's
  const std::uint8_t byte = 'x';
  ASSERT_TRUE(file->write({&byte, 1}));
  ASSERT_TRUE(file->finish(Durability::kSynced));
  ASSERT_TRUE(file->take_place());
  EXPECT_EQ(test::read_text(scratch_.path() / "after" / "a"), "x");
  EXPECT_TRUE(fs::is_empty(before));
}

TEST_F(TemporaryFileTest, SweepTakesOldFilesOfOursAndNothingElse) {
  const std::string single = ".flowdlo-0123456789abcdef.tmp";
  const std::string part = ".flowdlo-0123456789abcdef.part";
  const std::set<std::string> others = {
      "a.tmp", ".flowdlo-commit", ".flowdlo-1.tmp", ".flowdlo-0123456789abcdeF.tmp", "notes", part};
  for (const auto& name : others) test::write_text(scratch_.path() / name, "x");
  test::write_text(scratch_.path() / single, "x");
  fs::create_symlink("notes", scratch_.path() / ".flowdlo-1111111111111111.tmp");
  fs::create_directory(scratch_.path() / ".flowdlo-2222222222222222.tmp");

  Arranged calls;
  calls.later_s = kStaleAge_s - 10;
  sweep(folder(calls), kSingle);
  EXPECT_TRUE(names().contains(single)) << "its writer may still be there";
  calls.later_s = kStaleAge_s + 10;
  sweep(folder(calls), kSingle);
  auto left = others;
  left.insert({".flowdlo-1111111111111111.tmp", ".flowdlo-2222222222222222.tmp"});
  EXPECT_EQ(names(), left);
  sweep(folder(calls), kPart);
  EXPECT_FALSE(names().contains(part));
}

TEST_F(TemporaryFileTest, FsyncComesBeforeTheNameUnlessItIsTurnedOff) {
  class Order : public FailingCalls {
   public:
    int fsync(int file) const override {
      log += 's';
      return FailingCalls::fsync(file);
    }
    int renameat(int folder, const char* from, const char* to) const override {
      log += 'r';
      return FailingCalls::renameat(folder, from, to);
    }
    mutable std::string log;
  };
  for (const auto durability : {Durability::kSynced, Durability::kUnsynced}) {
    const Order calls;
    const Folder held = folder(calls);
    auto file = TemporaryFile::create(held, kSingle, "a");
    ASSERT_TRUE(file);
    ASSERT_TRUE(file->finish(durability));
    ASSERT_TRUE(file->take_place());
    EXPECT_EQ(calls.log, durability == Durability::kSynced ? "sr" : "r");
  }
}

}  // namespace
}  // namespace flowdlo::files
