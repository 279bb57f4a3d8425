#include "random/philox.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace flowdlo::random {
namespace {

using Words = std::array<std::uint32_t, 4>;

// The three vectors that Random123 publishes for philox4x32-10.
TEST(Philox, GivesTheKnownAnswerForZeros) {
  const Words expected = {0x6627e8d5U, 0xe169c58dU, 0xbc57ac4cU, 0x9b00dbd8U};
  EXPECT_EQ(philox_4x32_10({0, 0, 0, 0}, {0, 0}), expected);
}

TEST(Philox, GivesTheKnownAnswerForOnes) {
  constexpr std::uint32_t kOnes = 0xffffffffU;
  const Words expected = {0x408f276dU, 0x41c83b0eU, 0xa20bc7c6U, 0x6d5451fdU};
  EXPECT_EQ(philox_4x32_10({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}), expected);
}

TEST(Philox, GivesTheKnownAnswerForTheDigitsOfPi) {
  const Words expected = {0xd16cfe09U, 0x94fdccebU, 0x5001e420U, 0x24126ea1U};
  EXPECT_EQ(philox_4x32_10({0x243f6a88U, 0x85a308d3U, 0x13198a2eU, 0x03707344U},
                           {0xa4093822U, 0x299f31d0U}),
            expected);
}

TEST(Philox, PutsCounterStreamAndSeedLowWordFirst) {
  EXPECT_EQ(philox(0x299f31d0a4093822ULL, 0x85a308d3243f6a88ULL, 0x0370734413198a2eULL),
            philox_4x32_10({0x243f6a88U, 0x85a308d3U, 0x13198a2eU, 0x03707344U},
                           {0xa4093822U, 0x299f31d0U}));
}

TEST(Philox, SeedsStreamsAndCountersAreDistinct) {
  std::set<Words> blocks;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    for (std::uint64_t stream = 0; stream < 4; ++stream) {
      for (std::uint64_t counter = 0; counter < 64; ++counter) {
        blocks.insert(philox(seed, counter, stream));
      }
    }
  }
  EXPECT_EQ(blocks.size(), 4U * 4U * 64U);
}

TEST(Uniform, StaysInsideTheOpenUnitInterval) {
  EXPECT_GT(uniform(0), 0.0);
  EXPECT_LT(uniform(0xffffffffU), 1.0);
  EXPECT_DOUBLE_EQ(uniform(0x7fffffffU), 0.5 - 0x1p-33);
}

TEST(Gaussian, AnyOrderOfEvaluationGivesTheSameBits) {
  constexpr std::uint64_t kBlocks = 500;
  std::vector<std::array<float, 4>> forwards(kBlocks);
  std::vector<std::array<float, 4>> backwards(kBlocks);
  for (std::uint64_t i = 0; i < kBlocks; ++i) forwards[i] = gaussian(42, i, 3);
  for (std::uint64_t i = kBlocks; i-- > 0;) backwards[i] = gaussian(42, i, 3);
  EXPECT_EQ(forwards, backwards);
}

TEST(Gaussian, IsFiniteAndHasTheMomentsOfTheStandardNormal) {
  constexpr std::uint64_t kBlocks = 100000;
  constexpr double kCount = 4.0 * kBlocks;
  std::array<double, 5> moments{};
  for (std::uint64_t i = 0; i < kBlocks; ++i) {
    for (const float value : gaussian(7, i)) {
      ASSERT_TRUE(std::isfinite(value));
      double power = 1;
      for (double& moment : moments) {
        moment += power / kCount;
        power *= value;
      }
    }
  }
  // Five standard errors of each moment's estimate at this count.
  EXPECT_NEAR(moments[1], 0.0, 5 * std::sqrt(1.0 / kCount));
  EXPECT_NEAR(moments[2], 1.0, 5 * std::sqrt(2.0 / kCount));
  EXPECT_NEAR(moments[3], 0.0, 5 * std::sqrt(15.0 / kCount));
  EXPECT_NEAR(moments[4], 3.0, 5 * std::sqrt(96.0 / kCount));
}

TEST(Gaussian, ValuesOfOneBlockAreUncorrelated) {
  constexpr std::uint64_t kBlocks = 50000;
  std::array<std::array<double, 4>, 4> products{};
  for (std::uint64_t i = 0; i < kBlocks; ++i) {
    const auto block = gaussian(11, i);
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < a; ++b) products[a][b] += double{block[a]} * block[b] / kBlocks;
    }
  }
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      EXPECT_NEAR(products[a][b], 0.0, 5 / std::sqrt(double{kBlocks})) << a << ", " << b;
    }
  }
}

}  // namespace
}  // namespace flowdlo::random
