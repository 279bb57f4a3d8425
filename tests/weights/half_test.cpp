#include "weights/half.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "random/philox.hpp"

namespace flowdlo::weights {
namespace {

TEST(Half, EveryBitPatternReadsAsItsValue) {
  for (std::uint32_t pattern = 0; pattern <= 0xFFFFU; ++pattern) {
    const auto half = static_cast<std::uint16_t>(pattern);
    const float value = half_to_float(half);
    const float sign = (half & 0x8000U) != 0 ? -1.0F : 1.0F;
    const int exponent = (half >> 10U) & 0x1F;
    const auto mantissa = static_cast<float>(half & 0x3FFU);
    if (exponent == 31 && mantissa > 0) {
      ASSERT_TRUE(std::isnan(value)) << pattern;
    } else if (exponent == 31) {
      ASSERT_EQ(value, sign * std::numeric_limits<float>::infinity()) << pattern;
    } else {
      const float expected =
          exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024.0F + mantissa, exponent - 25);
      ASSERT_EQ(value, sign * expected) << pattern;
      ASSERT_EQ(std::signbit(value), (half & 0x8000U) != 0) << pattern;
    }
  }
}

TEST(Half, EveryNumberSurvivesTheWayThroughFloat) {
  for (std::uint32_t pattern = 0; pattern <= 0xFFFFU; ++pattern) {
    const auto half = static_cast<std::uint16_t>(pattern);
    if ((half & 0x7C00U) == 0x7C00U && (half & 0x03FFU) != 0) continue;  // NaN
    ASSERT_EQ(float_to_half(half_to_float(half)), half);
  }
}

TEST(Half, EveryNumberIsOneExactly) {
  for (std::uint32_t pattern = 0; pattern <= 0xFFFFU; ++pattern) {
    const auto half = static_cast<std::uint16_t>(pattern);
    const float value = half_to_float(half);
    ASSERT_EQ(is_half(value), std::isfinite(value)) << pattern;
    if (!std::isfinite(value)) continue;
    ASSERT_EQ(exact_half(value), half) << pattern;
  }
}

TEST(Half, NumbersBetweenAreNone) {
  for (std::uint64_t block = 0; block < 50000; ++block) {
    for (const std::uint32_t word : random::philox(2, block)) {
      const float value = std::bit_cast<float>(word);
      ASSERT_EQ(is_half(value),
                std::isfinite(value) && half_to_float(float_to_half(value)) == value)
          << value;
    }
  }
  EXPECT_FALSE(is_half(std::numeric_limits<float>::denorm_min()));
  EXPECT_FALSE(is_half(0x1.8p-24F)) << "between the first two subnormals";
  EXPECT_FALSE(is_half(65536.0F)) << "beyond the largest";
}

TEST(Half, TiesGoToTheEvenNeighbour) {
  EXPECT_EQ(half_to_float(float_to_half(2049.0F)), 2048.0F);
  EXPECT_EQ(half_to_float(float_to_half(2051.0F)), 2052.0F);
  EXPECT_EQ(float_to_half(0x1p-25F), 0U) << "half of the smallest subnormal";
  EXPECT_EQ(float_to_half(0x1.8p-24F), 2U) << "between the first two subnormals";
  EXPECT_EQ(float_to_half(std::nextafter(0x1p-25F, 1.0F)), 1U);
}

TEST(Half, OverflowsFromTheMiddleAboveTheLargestNumber) {
  EXPECT_EQ(float_to_half(std::nextafter(65520.0F, 0.0F)), 0x7BFFU);
  EXPECT_EQ(float_to_half(65520.0F), 0x7C00U);
  EXPECT_EQ(float_to_half(-1e30F), 0xFC00U);
  EXPECT_EQ(float_to_half(std::numeric_limits<float>::infinity()), 0x7C00U);
  EXPECT_TRUE(std::isnan(half_to_float(float_to_half(std::nanf("")))));
}

TEST(Half, RoundsAsEigenDoes) {
  for (std::uint64_t block = 0; block < 200000; ++block) {
    for (const std::uint32_t word : random::philox(1, block)) {
      // Exponents from below the subnormals to beyond the largest half; any mantissa and sign.
      const std::uint32_t exponent = 96 + (word >> 8U) % 50;
      const auto value = std::bit_cast<float>((word & 0x807FFFFFU) | exponent << 23U);
      ASSERT_EQ(float_to_half(value), Eigen::half(value).x) << value;
    }
  }
}

}  // namespace
}  // namespace flowdlo::weights
