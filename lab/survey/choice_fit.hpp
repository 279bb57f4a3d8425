// ChoiceFit: linear utilities under which the right option of each choice is the likeliest.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace flowdlo::survey {

/// Options as feature rows, and which one is right. P(row) is proportional to exp(row . weights).
/// Logistic regression is a choice of two: the features, and zeros.
struct Choice {
  Eigen::MatrixXd rows;  ///< [options, features]
  Eigen::Index right = 0;
  double weight = 1;
};

/// [features] weights of highest likelihood under a ridge penalty, by Newton's method. `fixed`
/// [features] says which of them stay 0; empty: none does.
[[nodiscard]] Eigen::VectorXd fit(const std::vector<Choice>& choices, Eigen::Index features,
                                  double ridge, const std::vector<bool>& fixed = {});

struct FitQuality {
  double unlikely = 0;  ///< mean negative logarithm of the right option's probability
  double right = 0;     ///< share of choices whose right option is the likeliest
};
[[nodiscard]] FitQuality quality_of(const std::vector<Choice>& choices,
                                    const Eigen::VectorXd& weights);

}  // namespace flowdlo::survey
