#include "estimator/comeback.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <new>
#include <vector>

#include "reference/program.hpp"
#include "support/conditions.hpp"

namespace flowdlo::estimator {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr auto kPatience = std::chrono::seconds(30);

OnDevice some_device() {
  const testing::WaveConditions conditions(1);
  return {"one", testing::make_sampler(
                     {}, [] { return reference::create_program(1); }, conditions, 1)};
}

std::optional<OnDevice> wait_for(Comeback& comeback) {
  const auto until = Clock::now() + kPatience;
  while (Clock::now() < until) {
    if (auto found = comeback.take()) return found;
    std::this_thread::sleep_for(milliseconds(1));
  }
  return std::nullopt;
}

TEST(Comeback, WaitsLongerAfterEachTryUpToABound) {
  std::mutex mutex;
  std::vector<Clock::time_point> tries{Clock::now()};
  {
    Comeback comeback(
        [&]() -> std::optional<OnDevice> {
          const std::lock_guard lock(mutex);
          tries.push_back(Clock::now());
          return std::nullopt;
        },
        {.first = milliseconds(20), .longest = milliseconds(80)});
    std::this_thread::sleep_for(milliseconds(600));
    EXPECT_FALSE(comeback.take());
  }
  ASSERT_GE(tries.size(), 4U);
  const std::vector<int> pauses_ms{20, 40, 80, 80, 80, 80, 80, 80, 80};
  ASSERT_LE(tries.size(), pauses_ms.size() + 1) << "the bound is not kept";
  for (std::size_t i = 1; i < tries.size(); ++i) {
    EXPECT_GE(tries[i] - tries[i - 1], milliseconds(pauses_ms[i - 1])) << i;
  }
}

TEST(Comeback, GivesWhatItFoundOnceAndTriesNoMore) {
  std::atomic<int> tries = 0;
  Comeback comeback(
      [&]() -> std::optional<OnDevice> {
        if (++tries == 1) throw std::bad_alloc();  // no reason to end
        if (tries == 2) return std::nullopt;
        return some_device();
      },
      {.first = milliseconds(1), .longest = milliseconds(1)});
  const auto found = wait_for(comeback);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->device, "one");
  EXPECT_FALSE(comeback.take());
  std::this_thread::sleep_for(milliseconds(30));
  EXPECT_EQ(tries, 3);
}

TEST(Comeback, EndsAtOnceWhereNothingIsUnderWay) {
  const auto start = Clock::now();
  {
    const Comeback comeback([]() -> std::optional<OnDevice> { return std::nullopt; });
  }
  EXPECT_LT(Clock::now() - start, milliseconds(900));
}

}  // namespace
}  // namespace flowdlo::estimator
