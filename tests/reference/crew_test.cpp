#include "reference/crew.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>

namespace flowdlo::reference {
namespace {

TEST(Crew, EveryThreadWorksOnceACall) {
  for (const int threads : {1, 2, 5}) {
    Crew crew(threads);
    ASSERT_EQ(crew.size(), threads);
    std::array<std::atomic<int>, 5> calls{};
    for (int round = 0; round < 50; ++round) {
      crew.run([&](int thread) { ++calls[static_cast<std::size_t>(thread)]; });
    }
    for (int thread = 0; thread < threads; ++thread) {
      EXPECT_EQ(calls[static_cast<std::size_t>(thread)], 50) << "thread " << thread;
    }
  }
}

TEST(Crew, NobodyGoesOnBeforeAllHaveMet) {
  constexpr int kThreads = 4;
  Crew crew(kThreads);
  std::atomic<int> arrived{0};
  std::atomic<int> early{0};
  crew.run([&](int) {
    for (int round = 1; round <= 200; ++round) {
      ++arrived;
      crew.meet();
      if (arrived < round * kThreads) ++early;
      crew.meet();
    }
  });
  EXPECT_EQ(early, 0);
}

TEST(Crew, ZeroThreadsStandForOneACore) { EXPECT_GE(Crew(0).size(), 1); }

}  // namespace
}  // namespace flowdlo::reference
