#include "eval/interval.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace flowdlo::eval {
namespace {

std::vector<double> wave(int count, double offset) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(offset + std::sin(1.7 * i));
  return values;
}

TEST(Interval, NoValuesGiveZeros) {
  const Interval interval = mean_interval({});
  EXPECT_EQ(interval.value, 0);
  EXPECT_EQ(interval.low, 0);
  EXPECT_EQ(interval.high, 0);
}

TEST(Interval, EqualValuesLeaveNoDoubt) {
  const std::vector<double> values(20, 3.5);
  const Interval interval = mean_interval(values);
  EXPECT_DOUBLE_EQ(interval.value, 3.5);
  EXPECT_DOUBLE_EQ(interval.low, 3.5);
  EXPECT_DOUBLE_EQ(interval.high, 3.5);
}

TEST(Interval, WidthIsThatOfTheMeansNormalDistribution) {
  const auto values = wave(400, 5);
  double variance = 0;
  const Interval interval = mean_interval(values);
  for (const double value : values) variance += (value - interval.value) * (value - interval.value);
  const double error = std::sqrt(variance / 400 / 400);
  EXPECT_NEAR(interval.high - interval.value, 1.96 * error, 0.15 * error);
  EXPECT_NEAR(interval.value - interval.low, 1.96 * error, 0.15 * error);
}

TEST(Interval, SameSeedGivesTheSameInterval) {
  const auto values = wave(50, 1);
  EXPECT_EQ(mean_interval(values).low, mean_interval(values).low);
  EXPECT_NE(mean_interval(values).low, mean_interval(values, 2000, 7).low);
}

TEST(Interval, RatioIsResampledInPairs) {
  const auto under = wave(60, 3);
  std::vector<double> over;
  for (const double value : under)
    over.push_back(0.8 * value);  // the spread cancels, scene by scene
  const Interval ratio = ratio_interval(over, under);
  EXPECT_NEAR(ratio.value, 0.8, 1e-12);
  EXPECT_NEAR(ratio.low, 0.8, 1e-12);
  EXPECT_NEAR(ratio.high, 0.8, 1e-12);
}

TEST(Interval, RatioToNothingIsInfinite) {
  const std::vector<double> over{1, 2};
  const std::vector<double> under{0, 0};
  EXPECT_TRUE(std::isinf(ratio_interval(over, under).value));
}

}  // namespace
}  // namespace flowdlo::eval
