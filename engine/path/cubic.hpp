// Cubic: the curve that leaves one point with a given derivative and enters another one.
#pragma once

#include <Eigen/Core>

namespace flowdlo::path {

/// In Hermite's form, over t in [0, 1].
struct Cubic {
  Eigen::Vector2f a, b;    ///< points
  Eigen::Vector2f da, db;  ///< derivatives there, along the way

  [[nodiscard]] Eigen::Vector2f at(float t) const {
    const float t2 = t * t;
    const float t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * da + (3 * t2 - 2 * t3) * b +
           (t3 - t2) * db;
  }
  [[nodiscard]] Eigen::Vector2f first_derivative(float t) const {
    return (6 * t - 6 * t * t) * (b - a) + (1 - 4 * t + 3 * t * t) * da + (3 * t * t - 2 * t) * db;
  }
  [[nodiscard]] Eigen::Vector2f second_derivative(float t) const {
    return (6 - 12 * t) * (b - a) + (6 * t - 4) * da + (6 * t - 2) * db;
  }
};

}  // namespace flowdlo::path
