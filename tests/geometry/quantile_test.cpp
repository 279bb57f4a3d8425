#include "geometry/quantile.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace flowdlo::geometry {
namespace {

TEST(Quantile, IsTheValueThatAShareDoesNotExceed) {
  EXPECT_EQ(quantile({5, 1, 4, 2, 3}, 0), 1);
  EXPECT_EQ(quantile({5, 1, 4, 2, 3}, 0.5F), 3);
  EXPECT_EQ(quantile({5, 1, 4, 2, 3}, 1), 5);
}

TEST(MedianOf, IsTheMiddleOne) {
  std::vector<double> values{9, -1, 4};
  EXPECT_EQ(median_of(values), 4);
}

TEST(MedianOf, IsTheUpperOfTwoInTheMiddle) {
  std::vector<float> values{4, 1, 3, 2};
  EXPECT_EQ(median_of(values), 3);
}

}  // namespace
}  // namespace flowdlo::geometry
