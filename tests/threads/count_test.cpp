#include "threads/count.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace flowdlo::threads {
namespace {

TEST(Count, ZeroStandsForOneACore) { EXPECT_EQ(count(0), cores()); }

TEST(Count, AFewAreTakenAsTheyWereAskedFor) {
  for (const int wanted : {1, 2, 5, kFew}) EXPECT_EQ(count(wanted), wanted);
}

TEST(Count, WhatNoMachineNeedsIsClamped) {
  EXPECT_EQ(count(1000000), std::max(cores(), kFew));
  EXPECT_EQ(count(-3), cores());
}

}  // namespace
}  // namespace flowdlo::threads
