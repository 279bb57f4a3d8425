#include "files/folder_update.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>

#include <array>
#include <map>

#include "files/failing_calls.hpp"
#include "files/open_together.hpp"
#include "frame/temporary_folder.hpp"

namespace flowdlo::files {
namespace {

namespace fs = std::filesystem;
using test::FailingCalls;
using test::Fault;
using test::read_text;
using testing::HasSubstr;
using Content = std::map<std::string, std::string>;

const Content kOld = {{"a", "old"}, {"gone", "old"}, {"key", "old"}};
const Content kNew = {{"a", "new"}, {"b", "new"}, {"key", "new"}};

Result<void> change(const fs::path& folder, const SystemCalls& calls = kernel()) {
  auto update = FolderUpdate::begin(folder, "key", Durability::kSynced, calls);
  if (!update) return update.error();
  for (const auto& [name, text] : kNew) {
    if (auto done = update->put(name, text); !done) return done;
  }
  update->remove("gone");
  return update->commit();
}

void write(const fs::path& folder, const Content& content) {
  fs::create_directories(folder);
  for (const auto& [name, text] : content) test::write_text(folder / name, text);
}

/// What open_together() finds.
Content read(const fs::path& folder) {
  constexpr std::array kNames = {"key", "a", "b", "gone"};
  const auto opened = open_together(folder, kNames);
  EXPECT_TRUE(opened) << opened.error().message;
  Content content;
  for (std::size_t i = 0; opened && i < kNames.size(); ++i) {
    EXPECT_FALSE((*opened)[i].error);
    if ((*opened)[i].file) content[kNames[i]] = (*opened)[i].file->read(100)->text();
  }
  return content;
}

/// What a program finds that knows nothing of records.
Content plain(const fs::path& folder) {
  Content content;
  for (const auto& [name, text] : kOld) {
    if (fs::exists(folder / name)) content[name] = read_text(folder / name);
  }
  for (const auto& [name, text] : kNew) {
    if (fs::exists(folder / name)) content[name] = read_text(folder / name);
  }
  return content;
}

TEST(FolderUpdate, ChangesWhatIsNamedAndNothingElse) {
  const test::TemporaryFolder scratch;
  write(scratch.path(), kOld);
  write(scratch.path(), {{"notes", "mine"}});
  ASSERT_TRUE(change(scratch.path()));
  EXPECT_EQ(plain(scratch.path()), kNew);
  EXPECT_EQ(read_text(scratch.path() / "notes"), "mine");
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch.path()), {}), 4) << "nothing stays";
}

TEST(FolderUpdate, ThatIsNotCommittedLeavesEverythingAsItWas) {
  const test::TemporaryFolder scratch;
  write(scratch.path(), kOld);
  {
    auto update = FolderUpdate::begin(scratch.path(), "key", Durability::kSynced);
    ASSERT_TRUE(update);
    ASSERT_TRUE(update->put("a", "new"));
  }
  EXPECT_EQ(plain(scratch.path()), kOld);
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch.path()), {}), 3);
}

// Names alone tell a program that reads no records that a folder is not whole.
TEST(FolderUpdate, EndedAnywhereShowsNoKeyBesideFilesOfTwoTimes) {
  const FailingCalls counting;
  {
    const test::TemporaryFolder scratch;
    write(scratch.path(), kOld);
    ASSERT_TRUE(change(scratch.path(), counting));
  }
  int without_key = 0;
  for (int at = 0; at < counting.count(); ++at) {
    const test::TemporaryFolder scratch;
    write(scratch.path(), kOld);
    (void)change(scratch.path(), FailingCalls({Fault::Kind::kKilled, EIO, at}));
    const Content names = plain(scratch.path());
    ASSERT_TRUE(names == kOld || names == kNew || !names.contains("key")) << "call " << at;
    without_key += names.contains("key") ? 0 : 1;
    const Content found = read(scratch.path());
    ASSERT_TRUE(found == kOld || found == kNew) << "call " << at;
  }
  EXPECT_GT(without_key, 0);
}

TEST(FolderUpdate, FolderInAFilesPlaceIsRefusedBeforeAnythingChanges) {
  for (const char* name : {"a", "b", "gone", "key"}) {
    const test::TemporaryFolder scratch;
    write(scratch.path(), {{"notes", "mine"}});
    fs::create_directories(scratch.path() / name / "full");
    const auto changed = change(scratch.path());
    ASSERT_FALSE(changed);
    EXPECT_THAT(changed.error().message, HasSubstr(name));
    EXPECT_EQ(std::distance(fs::directory_iterator(scratch.path()), {}), 2) << name;
  }
}

TEST(FolderUpdate, OfAnAlmostFullDiskSaysSoAndLeavesTheOldFiles) {
  const test::TemporaryFolder scratch;
  write(scratch.path(), kOld);
  const auto changed = change(scratch.path(), FailingCalls({Fault::Kind::kForGood, ENOSPC, 12}));
  ASSERT_FALSE(changed);
  EXPECT_THAT(changed.error().message, HasSubstr("No space left on device; make space"));
  EXPECT_EQ(read(scratch.path()), kOld);
}

TEST(FolderUpdate, ThatOnlyRemovesNeedsNoRoom) {
  class Full : public FailingCalls {
   public:
    int openat(int folder, const char* name, int flags, mode_t mode) const override {
      if ((flags & O_CREAT) == 0) return FailingCalls::openat(folder, name, flags, mode);
      errno = ENOSPC;
      return -1;
    }
  };
  const test::TemporaryFolder scratch;
  write(scratch.path(), kOld);
  const Full calls;
  auto update = FolderUpdate::begin(scratch.path(), "key", Durability::kSynced, calls);
  ASSERT_TRUE(update);
  for (const auto& [name, text] : kOld) update->remove(name);
  ASSERT_TRUE(update->commit());
  EXPECT_TRUE(fs::is_empty(scratch.path()));
}

TEST(OpenTogether, ThatNeverFindsAQuietMomentSaysSo) {
  /// Every file has another number each time it is looked at.
  class Restless : public FailingCalls {
   public:
    int fstatat(int folder, const char* name, struct stat& status, int flags) const override {
      const int got = FailingCalls::fstatat(folder, name, status, flags);
      status.st_ino = ++next_;
      return got;
    }

   private:
    mutable ino_t next_ = 0;
  };
  const test::TemporaryFolder scratch;
  write(scratch.path(), kOld);
  constexpr std::array kNames = {"key", "a"};
  const auto opened = open_together(scratch.path(), kNames, Restless());
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().message, HasSubstr("change all the time"));
}

}  // namespace
}  // namespace flowdlo::files
