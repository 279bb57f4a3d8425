#include "survey/in_parallel.hpp"

#include <gtest/gtest.h>

namespace flowdlo::survey {
namespace {

Result<std::uint64_t> square_of(Nothing, std::uint64_t index) {
  if (index == 12) return Error{ErrorCode::kBadInput, "twelve"};
  return index * index;
}

TEST(InParallel, OutcomesKeepTheirOrder) {
  int done = 0;
  const auto all = in_parallel<std::uint64_t>({10, 20}, 4, no_tool, square_of, [&] { ++done; });
  ASSERT_EQ(all.size(), 20U);
  EXPECT_EQ(done, 20);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i == 2) continue;
    ASSERT_TRUE(all[i]);
    EXPECT_EQ(*all[i], (10 + i) * (10 + i));
  }
}

TEST(InParallel, AFailureCostsItsSceneOnly) {
  const auto all = in_parallel<std::uint64_t>({10, 4}, 1, no_tool, square_of);
  ASSERT_EQ(all.size(), 4U);
  EXPECT_FALSE(all[2]);
  EXPECT_TRUE(all[3]);
}

TEST(InParallel, WithoutAToolEverySceneFailsAsItDid) {
  const auto no_luck = [] { return Result<Nothing>(Error{ErrorCode::kIo, "no tool"}); };
  const auto all = in_parallel<std::uint64_t>({0, 3}, 1, no_luck, square_of);
  ASSERT_EQ(all.size(), 3U);
  for (const auto& one : all) {
    ASSERT_FALSE(one);
    EXPECT_EQ(one.error().message, "no tool");
  }
}

}  // namespace
}  // namespace flowdlo::survey
