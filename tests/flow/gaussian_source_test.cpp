#include "flow/gaussian_source.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace flowdlo {
namespace {

TEST(GaussianSource, ADrawDoesNotDependOnHowManyThereAre) {
  const auto one = flow::gaussian_source(7, 1);
  const auto many = flow::gaussian_source(7, 16);
  EXPECT_TRUE(std::equal(one.begin(), one.end(), many.begin()));
}

TEST(GaussianSource, SeedsAndDrawsDiffer) {
  const auto a = flow::gaussian_source(7, 2);
  const auto b = flow::gaussian_source(8, 2);
  EXPECT_NE(a[0], b[0]);
  EXPECT_NE(a[0], a[64 * 4]);
}

TEST(GaussianSource, IsStandardNormal) {  // Sec. 3.5
  const auto source = flow::gaussian_source(1, 64);
  double sum = 0;
  double square = 0;
  double count = 0;
  for (std::size_t i = 0; i < source.size(); ++i) {
    if (i % 4 == 3) {
      EXPECT_EQ(source[i], 0.0F);
      continue;
    }
    sum += static_cast<double>(source[i]);
    square += static_cast<double>(source[i]) * static_cast<double>(source[i]);
    count += 1;
  }
  EXPECT_NEAR(sum / count, 0.0, 0.03);
  EXPECT_NEAR(square / count, 1.0, 0.05);
}

}  // namespace
}  // namespace flowdlo
