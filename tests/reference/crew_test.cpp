#include "reference/crew.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <memory>

#include "support/forked.hpp"
#include "support/thread_limit.hpp"
#include "threads/count.hpp"

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

TEST(Crew, GoesOnWithTheThreadsThatStarted) {
  for (const int more : {0, 1, 3}) {
    const testing::ThreadLimit limit(more);
    Crew crew(5);
    EXPECT_EQ(limit.refused(), 1);
    ASSERT_EQ(crew.size(), more + 1);
    std::atomic<int> calls{0};
    for (int round = 0; round < 20; ++round) {
      crew.run([&](int) {
        ++calls;
        crew.meet();
      });
    }
    EXPECT_EQ(calls, 20 * (more + 1));
  }
}

TEST(Crew, AnAbsurdCountIsClamped) { EXPECT_EQ(Crew(100000).size(), threads::count(100000)); }

TEST(Crew, MayBeDestroyedInAForkedProcess) {
  auto crew = std::make_unique<Crew>(3);
  crew->run([](int) {});
  EXPECT_EQ(testing::forked([&] {
              crew.reset();
              return 0;
            }),
            0);
  std::atomic<int> calls{0};
  crew->run([&](int) { ++calls; });
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace flowdlo::reference
