#include "gate_fit/quantile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace flowdlo::lab {
namespace {

/// Sizes of normal deviates, whose deviation is exp(feature).
std::vector<ScaleRow> normal_rows(int count) {
  std::mt19937_64 engine(7);
  const auto uniform = [&] {
    return (static_cast<double>(engine() >> 11) + 0.5) / 9007199254740992;
  };
  std::vector<ScaleRow> rows;
  for (int i = 0; i < count; ++i) {
    const double log_deviation = 4 * uniform() - 2;
    const double deviate =
        std::sqrt(-2 * std::log(uniform())) * std::cos(6.283185307179586 * uniform());
    rows.push_back({{1, log_deviation}, std::log(std::abs(deviate) + 1e-9) + log_deviation});
  }
  return rows;
}

TEST(FitScale, FindsTheDeviationOfNormalValues) {
  const auto weights = fit_scale(normal_rows(20000), 0);
  EXPECT_NEAR(weights[0], 0, 0.06);
  EXPECT_NEAR(weights[1], 1, 0.05);
}

TEST(FitScale, CoversTheSharesItPromises) {
  const auto rows = normal_rows(20000);
  const auto weights = fit_scale(rows, 0);
  double one = 0;
  double two = 0;
  for (const ScaleRow& row : rows) {
    const double off = row.log_value - weights[0] - weights[1] * row.features[1];
    one += off <= 0 ? 1.0 / 20000 : 0;
    two += off <= std::log(2.0) ? 1.0 / 20000 : 0;
  }
  EXPECT_NEAR(one, 0.68, 0.03);
  EXPECT_NEAR(two, 0.95, 0.03);
}

}  // namespace
}  // namespace flowdlo::lab
