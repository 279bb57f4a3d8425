// A crew where the system gives too few threads, and in a forked process, where it has none.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>

#include "reference/crew.hpp"
#include "support/forked.hpp"
#include "support/thread_limit.hpp"
#include "threads/count.hpp"

namespace flowdlo::reference {
namespace {

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
