#include "soak/growth.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <cstring>
#include <thread>
#include <vector>

namespace flowdlo::soak {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr Allowance kAllowance{
    .resident_mb = 8, .heap_mb = 0.25, .heap_mb_a_life = 0.004, .descriptors = 0, .threads = 0};

Growth grown(int lives, double mb_a_life, double files_a_life, double heap_mb_a_life = 0) {
  Growth growth;
  for (int i = 0; i < lives; ++i) {
    const double sway = i % 3;  // as the sizes of frames bring it
    growth.add({100 + sway + mb_a_life * i, 2 + heap_mb_a_life * i,
                5 + static_cast<int>(files_a_life * i), 1});
  }
  return growth;
}

TEST(Growth, FlatFootprintHasNoFault) {
  EXPECT_THAT(grown(40, 0, 0).faults(kAllowance), IsEmpty());
}

TEST(Growth, MemoryThatGrowsSlowlyIsFound) {
  EXPECT_THAT(grown(100, 0.2, 0).faults(kAllowance), ElementsAre(HasSubstr("resident MB")));
}

TEST(Growth, WhatIsAllowedALifeIsNoFaultAndTwiceAsMuchIs) {
  EXPECT_THAT(grown(1000, 0, 0, 0.004).faults(kAllowance), IsEmpty());
  EXPECT_THAT(grown(1000, 0, 0, 0.008).faults(kAllowance), ElementsAre(HasSubstr("heap MB")));
}

TEST(Growth, OneFileInTenLivesIsFound) {
  EXPECT_THAT(grown(100, 0, 0.1).faults(kAllowance), ElementsAre(HasSubstr("open files")));
}

TEST(Growth, WhatTheFirstLivesTakeIsNoGrowth) {
  Growth growth;
  for (int i = 0; i < 40; ++i)
    growth.add({i < 8 ? 50.0 + 10 * i : 130.0, i < 8 ? 1.0 * i : 8.0, 5, 1});
  EXPECT_THAT(growth.faults(kAllowance), IsEmpty());
}

TEST(Growth, TooFewLivesTellNothing) { EXPECT_THAT(grown(7, 50, 1).faults(kAllowance), IsEmpty()); }

TEST(Footprint, SeesMemoryFilesAndThreads) {
  const Footprint before = footprint();
  std::vector<char> memory(64 << 20);
  std::memset(memory.data(), 1, memory.size());
  const int file = ::open("/dev/null", O_RDONLY);
  Footprint held;
  const std::vector<std::vector<char>> pieces(5000, std::vector<char>(1000));
  std::thread([&] { held = footprint(); }).join();
  ::close(file);

  EXPECT_GE(held.resident_mb, before.resident_mb + 50);
  if (before.heap_mb > 0) {
    EXPECT_GE(held.heap_mb, before.heap_mb + 64 + 5);
  }
  EXPECT_EQ(held.descriptors, before.descriptors + 1);
  EXPECT_EQ(held.threads, before.threads + 1);
}

}  // namespace
}  // namespace flowdlo::soak
