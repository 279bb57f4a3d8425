#include "reference/program.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "reference/block_program.hpp"

namespace flowdlo {
namespace {

using testing::BlockProgram;

TEST(Program, BitsDoNotDependOnThreads) {
  for (const int draws : {1, 3, 4}) {
    const auto alone = BlockProgram(reference::create_program(1), draws).run();
    for (const int threads : {2, 3, 4}) {
      EXPECT_EQ(BlockProgram(reference::create_program(threads), draws).run(), alone)
          << draws << " draws on " << threads << " threads";
    }
  }
}

TEST(Program, DrawsOfTheSameInputAreTheSame) {
  for (const int draws : {2, 6}) {  // 6: more rows than keys, so that draws see themselves alone
    const auto all = BlockProgram(reference::create_program(2), draws).run();
    const auto last = static_cast<std::ptrdiff_t>(draws - 1) * 64 * 256;
    EXPECT_TRUE(std::equal(all.begin(), all.begin() + 64 * 256, all.begin() + last)) << draws;
  }
}

TEST(Program, EveryInstructionSetOfThisProcessorAgrees) {
  const auto sets = reference::kernels_of_this_cpu();
  if (sets.size() == 1) GTEST_SKIP() << "this processor has " << sets.back().isa << " alone";
  ASSERT_EQ(sets.back().isa, std::string("baseline"));
  const auto expected = BlockProgram(reference::create_program(2, sets.back()), 4).run();
  float largest = 0;
  for (const float value : expected) largest = std::max(largest, std::abs(value));
  ASSERT_GT(largest, 0.1F);
  for (const auto& kernels : sets.first(sets.size() - 1)) {
    const auto got = BlockProgram(reference::create_program(2, kernels), 4).run();
    for (std::size_t i = 0; i < got.size(); ++i) {
      ASSERT_NEAR(got[i], expected[i], 2e-5F * largest) << kernels.isa << " at " << i;
    }
  }
}

}  // namespace
}  // namespace flowdlo
