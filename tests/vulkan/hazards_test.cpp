#include "vulkan/hazards.hpp"

#include <gtest/gtest.h>

namespace flowdlo::vulkan {
namespace {

constexpr Range kFirstHalf{1, 0, 64};
constexpr Range kSecondHalf{1, 64, 64};
constexpr Range kOther{2, 0, 64};

TEST(Hazards, LetReadersOfTheSameBytesRunTogether) {
  Hazards hazards;
  hazards.add(kFirstHalf, false);
  EXPECT_FALSE(hazards.conflict(kFirstHalf, false));
}

TEST(Hazards, HoldAReaderBackUntilTheWriterIsDone) {
  Hazards hazards;
  hazards.add(kFirstHalf, true);
  EXPECT_TRUE(hazards.conflict({1, 32, 64}, false));
  hazards.clear();
  EXPECT_FALSE(hazards.conflict({1, 32, 64}, false));
}

TEST(Hazards, HoldAWriterBackUntilReadersAndWritersAreDone) {
  Hazards read;
  read.add(kFirstHalf, false);
  EXPECT_TRUE(read.conflict(kFirstHalf, true));
  Hazards written;
  written.add(kFirstHalf, true);
  EXPECT_TRUE(written.conflict(kFirstHalf, true));
}

TEST(Hazards, DoNotMixUpNeighbouringBytesOrResources) {
  Hazards hazards;
  hazards.add(kFirstHalf, true);
  EXPECT_FALSE(hazards.conflict(kSecondHalf, true));
  EXPECT_FALSE(hazards.conflict(kOther, true));
}

}  // namespace
}  // namespace flowdlo::vulkan
