#include "eval/row_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eval/merged_rows.hpp"
#include "eval/tables.hpp"
#include "eval/trials.hpp"
#include "frame/temporary_folder.hpp"

namespace flowdlo::eval {
namespace {

namespace fs = std::filesystem;
using flowdlo::test::read_text;
using flowdlo::test::TemporaryFolder;
using flowdlo::test::write_text;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::vector<std::string> kFrames{"a", "b", "c", "d", "e"};

RunInfo run_info(Shard shard = {}) {
  return {settings_of(Config{}, "0123"), "model.fdw", "cpu", kFrames, shard};
}

Row row_of(std::size_t index) {
  const double at = static_cast<double>(index);
  return {index, test::trial(kFrames[index], 4 + at, 1 + at, 2 + at / 3, 0.5)};
}

// Evaluates `most` of the rows that the file lacks, and goes.
fs::path add_rows(const fs::path& folder, const RunInfo& info, std::size_t most = 99) {
  auto file = RowFile::open(folder, info);
  EXPECT_TRUE(file) << file.error().message;
  std::size_t count = 0;
  for (const std::size_t index : file->lacking()) {
    if (count++ == most) break;
    EXPECT_TRUE(file->append(row_of(index)));
  }
  return file->path();
}

std::vector<std::size_t> lacking(const fs::path& folder, const RunInfo& info) {
  const auto file = RowFile::open(folder, info);
  EXPECT_TRUE(file) << file.error().message;
  return file->lacking();
}

TEST(RowFile, OfANewRunLacksTheRowsOfItsShard) {
  const TemporaryFolder folder;
  EXPECT_THAT(lacking(folder.path(), run_info()), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(lacking(folder.path(), run_info({2, 3})), ElementsAre(1, 4));
}

TEST(RowFile, StoppedRunGoesOnWithTheRowsItLacks) {
  const TemporaryFolder folder;
  add_rows(folder.path(), run_info(), 2);
  EXPECT_THAT(lacking(folder.path(), run_info()), ElementsAre(2, 3, 4));
}

TEST(RowFile, HalfARowIsDroppedAndDoneAgain) {
  const TemporaryFolder folder;
  const auto path = add_rows(folder.path(), run_info(), 3);
  const std::string whole = read_text(path);
  for (const std::size_t cut : {1U, 40U, 400U}) {  // from the end of the third row
    write_text(path, whole.substr(0, whole.size() - cut));
    EXPECT_THAT(lacking(folder.path(), run_info()), ElementsAre(2, 3, 4)) << cut;
    add_rows(folder.path(), run_info(), 1);
    EXPECT_EQ(read_text(path), whole) << cut;
  }
}

TEST(RowFile, HalfAFirstLineIsANewRun) {
  const TemporaryFolder folder;
  const auto path = add_rows(folder.path(), run_info(), 0);
  write_text(path, read_text(path).substr(0, 20));
  EXPECT_THAT(lacking(folder.path(), run_info()), ElementsAre(0, 1, 2, 3, 4));
}

TEST(RowFile, WholeRunThatIsDoneStartsOver) {
  const TemporaryFolder folder;
  add_rows(folder.path(), run_info());
  EXPECT_THAT(lacking(folder.path(), run_info()), ElementsAre(0, 1, 2, 3, 4));
}

TEST(RowFile, PartThatIsDoneStays) {
  const TemporaryFolder folder;
  add_rows(folder.path(), run_info({2, 3}));
  EXPECT_THAT(lacking(folder.path(), run_info({2, 3})), IsEmpty());
}

TEST(RowFile, RowsOfAnotherRunAreNotMixed) {
  const TemporaryFolder folder;
  add_rows(folder.path(), run_info(), 2);
  RunInfo other = run_info();
  other.settings["draws"] = "7";
  const auto file = RowFile::open(folder.path(), other);
  ASSERT_FALSE(file);
  EXPECT_THAT(file.error().message, HasSubstr("draws is 4 and 7"));
  other = run_info();
  other.device = "another";
  EXPECT_FALSE(RowFile::open(folder.path(), other));
  other = run_info();
  other.frames[4] = "z";
  EXPECT_FALSE(RowFile::open(folder.path(), other));
}

TEST(RowFile, IsOpenForOneRunAtATime) {
  const TemporaryFolder folder;
  const auto first = RowFile::open(folder.path(), run_info());
  ASSERT_TRUE(first);
  const auto second = RowFile::open(folder.path(), run_info());
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().message, HasSubstr("another run is writing it"));
}

TEST(RowFile, DamageInsideIsNamedByItsLineAndLeftAlone) {
  const TemporaryFolder folder;
  const auto path = add_rows(folder.path(), run_info(), 3);
  std::string text = read_text(path);
  text[text.find('\n') + 1] = '#';
  write_text(path, text);
  const auto file = RowFile::open(folder.path(), run_info());
  ASSERT_FALSE(file);
  EXPECT_THAT(file.error().message, HasSubstr("rows.jsonl:2: expected a row"));
  EXPECT_EQ(read_text(path), text);
}

TEST(RowFile, FileOfSomethingElseIsLeftAlone) {
  const TemporaryFolder folder;
  write_text(folder.path() / "rows.jsonl", "{\"mine\": 1}\n");
  EXPECT_FALSE(RowFile::open(folder.path(), run_info()));
  EXPECT_EQ(read_text(folder.path() / "rows.jsonl"), "{\"mine\": 1}\n");
}

TEST(RowFile, RowTwiceIsRefused) {
  const TemporaryFolder folder;
  const auto path = add_rows(folder.path(), run_info(), 1);
  const std::string text = read_text(path);
  write_text(path, text + text.substr(text.find('\n') + 1));
  EXPECT_FALSE(read_row_file(path));
}

TEST(RowFile, FolderThatIsNotThereIsAnError) {
  const auto file = RowFile::open("no/such/folder", run_info());
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().code, ErrorCode::kIo);
}

TEST(MergedRows, OfPartsAreThoseOfTheWhole) {
  const TemporaryFolder whole;
  const TemporaryFolder parts;
  add_rows(whole.path(), run_info());
  for (int index = 3; index >= 1; --index) add_rows(parts.path(), run_info({index, 3}));
  const auto one = merge_rows({whole.path()});
  const auto other = merge_rows({parts.path()});
  ASSERT_TRUE(one) << one.error().message;
  ASSERT_TRUE(other) << other.error().message;
  EXPECT_EQ(tables_markdown(other->trials), tables_markdown(one->trials));
  EXPECT_EQ(rows_csv(other->trials), rows_csv(one->trials));
  EXPECT_EQ(heading(other->info, other->devices), heading(one->info, one->devices));
}

TEST(MergedRows, MayLieInSeveralFoldersAndTwice) {
  const TemporaryFolder first;
  const TemporaryFolder second;
  add_rows(first.path(), run_info({1, 2}));
  const auto file = add_rows(second.path(), run_info({2, 2}));
  EXPECT_TRUE(merge_rows({first.path(), second.path(), file}));
}

TEST(MergedRows, LackingOnesAreNamed) {
  const TemporaryFolder folder;
  add_rows(folder.path(), run_info({1, 2}));
  add_rows(folder.path(), run_info({2, 2}), 1);
  const auto merged = merge_rows({folder.path()});
  ASSERT_FALSE(merged);
  EXPECT_THAT(merged.error().message, HasSubstr("1 of 5 rows are lacking: d;"));
}

TEST(MergedRows, OfTwoRunsAreRefused) {
  const TemporaryFolder folder;
  add_rows(folder.path(), run_info({1, 2}));
  RunInfo other = run_info({2, 2});
  other.settings["seed"] = "9";
  add_rows(folder.path(), other);
  const auto merged = merge_rows({folder.path()});
  ASSERT_FALSE(merged);
  EXPECT_THAT(merged.error().message, HasSubstr("seed is 0 and 9"));
}

TEST(MergedRows, ThatContradictEachOtherAreRefused) {
  const TemporaryFolder folder;
  add_rows(folder.path(), run_info());
  auto file = RowFile::open(folder.path(), run_info({1, 5}));
  ASSERT_TRUE(file);
  Row row = row_of(0);
  row.trial.confidence = 0.3;
  ASSERT_TRUE(file->append(row));
  const auto merged = merge_rows({folder.path()});
  ASSERT_FALSE(merged);
  EXPECT_THAT(merged.error().message, HasSubstr("different rows for frame \"a\""));
}

TEST(MergedRows, NameEveryDevice) {
  const TemporaryFolder folder;
  add_rows(folder.path(), run_info({1, 2}));
  RunInfo other = run_info({2, 2});
  other.device = "Radeon";
  add_rows(folder.path(), other);
  const auto merged = merge_rows({folder.path()});
  ASSERT_TRUE(merged) << merged.error().message;
  EXPECT_EQ(merged->devices, "Radeon and cpu");
}

TEST(MergedRows, FolderWithoutRowsIsNamed) {
  const TemporaryFolder folder;
  const auto merged = merge_rows({folder.path()});
  ASSERT_FALSE(merged);
  EXPECT_THAT(merged.error().message, HasSubstr(folder.path().string()));
}

}  // namespace
}  // namespace flowdlo::eval
