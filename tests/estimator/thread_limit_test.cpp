// What an estimator does on a machine that gives it fewer threads than it asks for.
#include <gtest/gtest.h>

#include "flowdlo/estimator.hpp"
#include "support/rose_frame.hpp"
#include "support/thread_limit.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo {
namespace {

using testing::ThreadLimit;
using testing::WaveFrame;

Config config(int threads) {
  return {.weights = FLOWDLO_DEFAULT_WEIGHTS,
          .device = "cpu",
          .euler_steps = 1,
          .draws = 3,
          .threads = threads};
}

TEST(FewThreads, GiveTheSameBits) {
  const testing::RoseFrame frame;
  auto all = Estimator::create(config(4));
  ASSERT_TRUE(all) << all.error().message;
  const auto expected = all->estimate(frame.frame());
  ASSERT_TRUE(expected);
  ASSERT_GT(expected->readings, 1);
  for (const int more : {0, 1, 2}) {
    const ThreadLimit limit(more);
    auto some = Estimator::create(config(4));
    ASSERT_TRUE(some) << some.error().message;
    const auto got = some->estimate(frame.frame());
    EXPECT_GT(limit.refused(), 0);
    ASSERT_TRUE(got) << got.error().message;
    EXPECT_EQ(got->nodes, expected->nodes) << more << " threads more";
    EXPECT_EQ(got->sigma_m, expected->sigma_m);
    EXPECT_EQ(got->confidence, expected->confidence);
  }
}

TEST(ManyThreads, AreClampedAndGiveTheSameBits) {
  const WaveFrame wave;
  auto one = Estimator::create(config(1));
  auto many = Estimator::create(config(1024));
  ASSERT_TRUE(one && many);
  const auto expected = one->estimate(wave.frame());
  const auto got = many->estimate(wave.frame());
  ASSERT_TRUE(expected && got);
  EXPECT_EQ(got->nodes, expected->nodes);
  EXPECT_EQ(got->sigma_m, expected->sigma_m);
}

}  // namespace
}  // namespace flowdlo
