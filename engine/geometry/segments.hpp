// Segments of an image: where two of them meet.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <optional>

namespace flowdlo::geometry {

/// The vectors' lengths times the sine of the angle from p to q; positive from x to y.
template <class Scalar>
[[nodiscard]] Scalar cross(const Eigen::Matrix<Scalar, 2, 1>& p,
                           const Eigen::Matrix<Scalar, 2, 1>& q) {
  return p.x() * q.y() - p.y() * q.x();
}

/// Shares t and s, in [0, 1), at which a segment from a along d and one from b along e are in one
/// place; nothing where they do not meet, or are as good as parallel.
template <class Scalar>
[[nodiscard]] std::optional<std::array<Scalar, 2>> meeting(const Eigen::Matrix<Scalar, 2, 1>& a,
                                                           const Eigen::Matrix<Scalar, 2, 1>& d,
                                                           const Eigen::Matrix<Scalar, 2, 1>& b,
                                                           const Eigen::Matrix<Scalar, 2, 1>& e) {
  constexpr Scalar kParallel = sizeof(Scalar) == sizeof(float) ? Scalar(1e-6) : Scalar(1e-9);
  const Eigen::Matrix<Scalar, 2, 1> between = b - a;
  const Scalar turn = cross(d, e);
  if (std::abs(turn) < kParallel) return std::nullopt;
  const Scalar t = cross(between, e) / turn;
  const Scalar s = cross(between, d) / turn;
  if (t < 0 || t >= 1 || s < 0 || s >= 1) return std::nullopt;
  return std::array<Scalar, 2>{t, s};
}

}  // namespace flowdlo::geometry
