#include "survey/values.hpp"

#include <gtest/gtest.h>

namespace flowdlo::survey {
namespace {

TEST(Values, OfNothingAreZero) {
  const Values none;
  EXPECT_EQ(none.mean(), 0);
  EXPECT_EQ(none.median(), 0);
  EXPECT_EQ(none.percent_over(-1), 0);
}

TEST(Values, QuantilesDoNotDependOnTheOrder) {
  const Values values({4, 1, 3, 2, 5});
  EXPECT_EQ(values.mean(), 3);
  EXPECT_EQ(values.median(), 3);
  EXPECT_EQ(values.quantile(0.8), 5);
  EXPECT_EQ(values.most(), 5);
}

TEST(Values, OnTheLimitIsNotOverIt) {
  const Values values({1, 2, 2, 3});
  EXPECT_EQ(values.percent_over(2), 25);
}

}  // namespace
}  // namespace flowdlo::survey
