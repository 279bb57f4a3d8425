// Choice: linear utilities fitted so that the right candidate of each group is the likeliest.
#pragma once

#include <cstddef>
#include <vector>

namespace flowdlo::lab {

/// Candidates as feature rows, and which one is right. P(row) is proportional to
/// exp(weights . row). Logistic regression is a group of two: the features, and zeros.
struct Choice {
  std::vector<std::vector<double>> rows;  ///< [candidates, features]
  std::size_t right = 0;
  double weight = 1;
};

/// [features] weights of highest likelihood under a ridge penalty, by Newton's method.
[[nodiscard]] std::vector<double> fit(const std::vector<Choice>& choices, std::size_t features,
                                      double ridge);

}  // namespace flowdlo::lab
