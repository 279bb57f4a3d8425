#include "eval/shard.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flowdlo::eval {
namespace {

using testing::HasSubstr;

TEST(Shard, PartsOwnEveryRowOnce) {
  for (std::size_t row = 0; row < 20; ++row) {
    int owners = 0;
    for (int index = 1; index <= 3; ++index) owners += Shard{index, 3}.owns(row) ? 1 : 0;
    EXPECT_EQ(owners, 1) << row;
  }
}

TEST(Shard, IsReadFromItsText) {
  const auto shard = parse_shard("2/8");
  ASSERT_TRUE(shard);
  EXPECT_EQ(*shard, (Shard{2, 8}));
}

TEST(Shard, ThatIsNoneIsRefused) {
  for (const char* text : {"", "/", "1", "0/3", "4/3", "-1/3", "1/0", "1/3x", "a/b", "1/3/5",
                           "99999999999/99999999999", "1/100001"}) {
    const auto shard = parse_shard(text);
    ASSERT_FALSE(shard) << text;
    EXPECT_THAT(shard.error().message, HasSubstr("--shard: expected i/n")) << text;
  }
}

TEST(Shard, PartsWriteFilesOfTheirOwn) {
  EXPECT_EQ(row_file_name({1, 1}), "rows.jsonl");
  EXPECT_EQ(row_file_name({2, 8}), "rows-2-of-8.jsonl");
}

}  // namespace
}  // namespace flowdlo::eval
