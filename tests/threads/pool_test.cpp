#include "threads/pool.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <new>
#include <set>
#include <thread>
#include <vector>

#include "support/thread_limit.hpp"

namespace flowdlo::threads {
namespace {

constexpr int kPieces = 100;

TEST(Pool, EveryPieceIsDoneOnce) {
  for (const int threads : {1, 2, 5}) {
    Pool pool(threads);
    std::vector<std::atomic<int>> done(kPieces);
    Beside work(pool, kPieces, [&](int piece) { ++done[static_cast<std::size_t>(piece)]; });
    work.finish();
    for (const auto& times : done) EXPECT_EQ(times, 1);
  }
}

TEST(Pool, WorksBesideTheCaller) {
  Pool pool(2);
  std::latch begun(1);
  Beside work(pool, 1, [&](int) { begun.count_down(); });
  begun.wait();  // for ever, if nobody but the caller worked
  work.finish();
}

TEST(Pool, TheSameThreadsServeEveryTime) {
  Pool pool(3);
  std::mutex mutex;
  std::set<std::thread::id> seen;
  for (int i = 0; i < 50; ++i) {
    Beside work(pool, 8, [&](int) {
      const std::lock_guard lock(mutex);
      seen.insert(std::this_thread::get_id());
    });
    work.finish();
  }
  EXPECT_LE(seen.size(), 3U);
}

TEST(Pool, WhereNoThreadCanBeStartedTheCallerDoesAll) {
  const testing::ThreadLimit limit(0);
  Pool pool(4);
  std::set<std::thread::id> seen;
  Beside work(pool, kPieces, [&](int) { seen.insert(std::this_thread::get_id()); });
  work.finish();
  EXPECT_EQ(seen, std::set<std::thread::id>({std::this_thread::get_id()}));
  EXPECT_EQ(limit.refused(), 1);
}

TEST(Pool, WhatAPieceThrowsIsThrownByFinishAndTheOthersAreDone) {
  for (const int threads : {1, 3}) {
    Pool pool(threads);
    std::atomic<int> done = 0;
    Beside work(pool, kPieces, [&](int piece) {
      if (piece == 7) throw std::bad_alloc();
      ++done;
    });
    EXPECT_THROW(work.finish(), std::bad_alloc);
    EXPECT_EQ(done, kPieces - 1);
  }
}

TEST(Pool, WhatIsNotFinishedIsLeftAndThePoolGoesOn) {
  Pool pool(2);
  std::atomic<int> done = 0;
  {
    const Beside left(pool, 1000000, [&](int) { ++done; });
  }
  const int then = done;
  EXPECT_LT(then, 1000000);
  Beside work(pool, 3, [&](int) { ++done; });
  work.finish();
  EXPECT_EQ(done, then + 3);
}

TEST(Pool, ASecondThingIsDoneByItsCaller) {
  Pool pool(2);
  std::latch go(1);
  Beside first(pool, 1, [&](int) { go.wait(); });
  int done = 0;
  Beside second(pool, 3, [&](int) { ++done; });
  second.finish();
  EXPECT_EQ(done, 3);
  go.count_down();
  first.finish();
}

TEST(Pool, WhoWaitsForAPieceHelpsWithWhatItBegan) {
  Pool pool(2);
  std::set<std::thread::id> seen;
  std::mutex mutex;
  std::latch both(2);
  Beside outer(pool, 1, [&](int) {
    share_out(&pool, 2, [&](int) {
      both.arrive_and_wait();  // for ever, if one thread did both
      const std::lock_guard lock(mutex);
      seen.insert(std::this_thread::get_id());
    });
  });
  outer.finish();
  EXPECT_EQ(seen.size(), 2U);
}

TEST(Pool, WorkWithinWorkWithinWorkIsDoneOnce) {
  for (const int threads : {1, 2, 4}) {
    Pool pool(threads);
    std::atomic<int> done = 0;
    share_out(&pool, 5, [&](int) {
      share_out(&pool, 6, [&](int) { share_out(&pool, 7, [&](int) { ++done; }); });
    });
    EXPECT_EQ(done, 5 * 6 * 7);
  }
}

TEST(Pool, WhatWorkWithinWorkThrowsComesToTheOutermostCaller) {
  Pool pool(3);
  const auto inner = [&](int piece) {
    if (piece == 2) throw std::runtime_error("two");
  };
  EXPECT_THROW(share_out(&pool, 4, [&](int) { share_out(&pool, 4, inner); }), std::runtime_error);
}

TEST(Pool, NothingToDoIsDoneAtOnce) {
  Pool pool(2);
  Beside nothing(pool, 0, [](int) { FAIL(); });
  nothing.finish();
}

TEST(Pool, SharedOutWorkIsDoneOnceWithAPoolAndWithout) {
  Pool pool(3);
  for (Pool* const which : {&pool, static_cast<Pool*>(nullptr)}) {
    std::vector<std::atomic<int>> done(100);
    share_out(which, 100, [&](int piece) { ++done[static_cast<std::size_t>(piece)]; });
    for (const auto& times : done) EXPECT_EQ(times, 1);
  }
}

TEST(Pool, WhatSharedOutWorkThrowsComesToItsCaller) {
  Pool pool(2);
  const auto fails = [](int piece) {
    if (piece == 5) throw std::runtime_error("five");
  };
  EXPECT_THROW(share_out(&pool, 9, fails), std::runtime_error);
  EXPECT_THROW(share_out(nullptr, 9, fails), std::runtime_error);
}

}  // namespace
}  // namespace flowdlo::threads
