#include "reference/schedule.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace flowdlo::reference {
namespace {

TEST(Schedule, EveryBlockOfEveryStepIsDoneOnceARun) {
  for (const int threads : {1, 2, 3}) {
    for (const int blocks : {1, 2, 3, 4, 6, 7}) {
      Crew crew(threads);
      Schedule schedule;
      std::vector<std::atomic<int>> shares(static_cast<std::size_t>(blocks) * 2);
      for (std::size_t step = 0; step < 2; ++step) {
        schedule.add({.blocks = blocks,
                      .parts = 4,
                      .work =
                          [&, step](const Piece& piece) {
                            for (int b = piece.block; b < piece.block + piece.blocks; ++b) {
                              shares[step * static_cast<std::size_t>(blocks) +
                                     static_cast<std::size_t>(b)] += 4 / piece.parts;
                            }
                          },
                      .reads_beyond = {},
                      .writes = 0});
      }
      schedule.settle(crew);
      schedule.run(crew);
      schedule.run(crew);
      for (const auto& share : shares) {
        EXPECT_EQ(share, 8) << threads << " threads, " << blocks << " blocks";
      }
    }
  }
}

TEST(Schedule, AStepThatReadsBeyondItsRowsWaitsForAllOfThem) {
  constexpr int kBlocks = 4;
  Crew crew(2);
  Schedule schedule;
  std::atomic<int> written{0};
  std::atomic<int> least{kBlocks};
  schedule.add({.blocks = kBlocks,
                .work =
                    [&](const Piece& piece) {
                      if (piece.block > 0) {
                        std::this_thread::sleep_for(std::chrono::milliseconds(5));
                      }
                      written += piece.blocks;
                    },
                .reads_beyond = {},
                .writes = 7});
  schedule.add({.blocks = kBlocks,
                .work =
                    [&](const Piece&) {
                      if (written < least) least = written.load();
                    },
                .reads_beyond = {7},
                .writes = 8});
  schedule.settle(crew);
  schedule.run(crew);
  EXPECT_EQ(least, kBlocks);
}

TEST(Schedule, TimesOfAStageThatComesBackAreAdded) {
  Crew crew(1);
  Schedule schedule;
  const auto nap = [](const Piece&) { std::this_thread::sleep_for(std::chrono::milliseconds(2)); };
  for (const char* name : {"a", "b", "a"}) {
    schedule.stage(name);
    schedule.add({.work = nap, .reads_beyond = {}});
  }
  schedule.settle(crew);
  schedule.run(crew);
  ASSERT_EQ(schedule.times_ms().size(), 2U);
  EXPECT_EQ(schedule.times_ms()[0].first, "a");
  EXPECT_GE(schedule.times_ms()[0].second, 4.0);
  EXPECT_GE(schedule.times_ms()[1].second, 2.0);
}

}  // namespace
}  // namespace flowdlo::reference
