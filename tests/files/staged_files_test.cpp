#include "files/staged_files.hpp"

#include <gtest/gtest.h>

#include <iterator>

#include "frame/temporary_folder.hpp"

namespace flowdlo::files {
namespace {

namespace fs = std::filesystem;
using test::read_text;

std::ptrdiff_t entries(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

TEST(StagedFiles, NothingAppearsBeforeCommit) {
  const test::TemporaryFolder folder;
  StagedFiles staged;
  ASSERT_TRUE(staged.add(folder.path() / "a.txt", std::string_view("new")));
  EXPECT_FALSE(fs::exists(folder.path() / "a.txt"));
  ASSERT_TRUE(staged.commit());
  EXPECT_EQ(read_text(folder.path() / "a.txt"), "new");
  EXPECT_EQ(entries(folder.path()), 1) << "no temporary file stays";
}

TEST(StagedFiles, OldContentStaysWhenNothingIsCommitted) {
  const test::TemporaryFolder folder;
  test::write_text(folder.path() / "a.txt", "old");
  {
    StagedFiles staged;
    ASSERT_TRUE(staged.add(folder.path() / "a.txt", std::string_view("new")));
  }
  EXPECT_EQ(read_text(folder.path() / "a.txt"), "old");
  EXPECT_EQ(entries(folder.path()), 1);
}

TEST(StagedFiles, MissingFolderIsAnErrorThatNamesTheFile) {
  const test::TemporaryFolder folder;
  StagedFiles staged;
  const auto added = staged.add(folder.path() / "none" / "a.txt", std::string_view("new"));
  ASSERT_FALSE(added);
  EXPECT_EQ(added.error().code, ErrorCode::kIo);
  EXPECT_NE(added.error().message.find("a.txt"), std::string::npos);
}

TEST(StagedFiles, FolderInPlaceOfTheFileIsAnError) {
  const test::TemporaryFolder folder;
  fs::create_directories(folder.path() / "a.txt" / "full");
  StagedFiles staged;
  ASSERT_TRUE(staged.add(folder.path() / "a.txt", std::string_view("new")));
  const auto committed = staged.commit();
  ASSERT_FALSE(committed);
  EXPECT_EQ(committed.error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace flowdlo::files
