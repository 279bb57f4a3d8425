#include "threads/team.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <new>
#include <set>
#include <stdexcept>

#include "support/thread_limit.hpp"

namespace flowdlo::threads {
namespace {

/// Who of `threads` came to work.
std::multiset<int> workers(int threads) {
  std::mutex mutex;
  std::multiset<int> came;
  work_together(threads, [&](int who) {
    const std::lock_guard lock(mutex);
    came.insert(who);
  });
  return came;
}

TEST(Team, EachWorksOnce) {
  EXPECT_EQ(workers(1), std::multiset<int>({0}));
  EXPECT_EQ(workers(4), std::multiset<int>({0, 1, 2, 3}));
}

TEST(Team, GoesOnWithThoseThatStarted) {
  const testing::ThreadLimit limit(2);
  EXPECT_EQ(workers(8), std::multiset<int>({0, 1, 2}));
  EXPECT_EQ(limit.refused(), 1) << "after the first refusal nobody asks again";
}

TEST(Team, TheCallerWorksAloneWhereNoThreadCanBeStarted) {
  const testing::ThreadLimit limit(0);
  EXPECT_EQ(workers(8), std::multiset<int>({0}));
}

TEST(Team, AMillionThreadsAreNotStarted) {
  EXPECT_EQ(workers(1000000).size(), static_cast<std::size_t>(count(1000000)));
}

TEST(Team, WhatAWorkerThrowsIsThrownByTheCall) {
  for (const int culprit : {0, 1, 3}) {
    std::atomic<int> done = 0;
    const auto work = [&](int who) {
      if (who == culprit) throw std::bad_alloc();
      ++done;
    };
    EXPECT_THROW(work_together(4, work), std::bad_alloc);
    EXPECT_EQ(done, 3) << "the others end what they began";
  }
}

}  // namespace
}  // namespace flowdlo::threads
