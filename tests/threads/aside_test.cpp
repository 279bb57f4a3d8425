#include "threads/aside.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>

#include "support/thread_limit.hpp"

namespace flowdlo::threads {
namespace {

std::thread::id here() { return std::this_thread::get_id(); }

TEST(Aside, RunsOnAThreadOfItsOwnWhereOneIsWanted) {
  EXPECT_NE(aside(true, here).get(), here());
  EXPECT_EQ(aside(false, here).get(), here());
}

TEST(Aside, RunsHereWhereNoThreadCanBeStarted) {
  const testing::ThreadLimit limit(0);
  EXPECT_EQ(aside(true, here).get(), here());
  EXPECT_EQ(limit.refused(), 1);
}

TEST(Aside, HandsOverWhatIsThrown) {
  for (const bool wanted : {true, false}) {
    auto future = aside(wanted, []() -> int { throw std::runtime_error("odd"); });
    EXPECT_THROW((void)future.get(), std::runtime_error);
  }
}

}  // namespace
}  // namespace flowdlo::threads
