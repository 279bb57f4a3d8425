// How a listing's loops are found, and how their turns replace the compiler's guess.
#include "gpu_compile/estimate.hpp"

#include <gmock/gmock.h>

namespace flowdlo::gpu_compile {
namespace {

using ::testing::ElementsAre;

TEST(Loops, OfAListingWithoutBranchesBackAreNone) {
  EXPECT_THAT(instructions_by_depth("BB0:\n\tv_add a, b ; 00\n\ts_cbranch_execz BB2\nBB1:\n\tv_mul "
                                    "a, b\nBB2:\n\ts_endpgm\n"),
              ElementsAre(4));
}

TEST(Loops, CountTheBlocksBetweenABranchAndWhereItGoesBackTo) {
  EXPECT_THAT(instructions_by_depth("BB0:\n\tv_a\nBB1:\n\tv_b\n\ts_cbranch_scc1 BB3\nBB2:\n\tv_c\n"
                                    "\ts_branch BB1  ; ff\nBB3:\n\ts_endpgm\n"),
              ElementsAre(2, 4));
}

TEST(Loops, MayLieWithinEachOther) {
  EXPECT_THAT(
      instructions_by_depth("BB0:\n\tv_a\nBB1:\n\tv_b\nBB2:\n\tv_c\n\ts_cbranch_scc1 BB2\nBB3:\n"
                            "\ts_cbranch_scc0 BB1\nBB4:\n\ts_endpgm\n"),
      ElementsAre(2, 2, 2));
}

TEST(Loops, OfTwoBranchesBackToOnePlaceAreOne) {
  EXPECT_THAT(instructions_by_depth("BB1:\n\tv_a\n\ts_cbranch_scc1 BB1\nBB2:\n\ts_branch BB1\n"),
              ElementsAre(0, 3));
}

TEST(Turns, TakeThePlaceOfTheCompilersEight) {
  EXPECT_DOUBLE_EQ(with_turns(100, {20, 10}, {8}), 100);
  EXPECT_DOUBLE_EQ(with_turns(100, {20, 10}, {16}), 180);  // 20 + 160 of 20 + 80
  EXPECT_DOUBLE_EQ(with_turns(100, {20, 10}, {}), 100) << "its guess has to do";
  EXPECT_DOUBLE_EQ(with_turns(100, {20}, {16}), 100) << "there is no loop";
}

TEST(Turns, OfALoopWithinALoopMultiply) {
  EXPECT_DOUBLE_EQ(with_turns(320, {0, 0, 1}, {3, 8}), 240);  // 24 turns of 32
  EXPECT_DOUBLE_EQ(with_turns(80, {0, 1}, {3, 5}), 50) << "of two loops the inner one is left";
}

}  // namespace
}  // namespace flowdlo::gpu_compile
