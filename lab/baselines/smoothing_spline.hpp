// SmoothingSpline: a parametric cubic spline through noisy points in space (P. Dierckx, "Curve and
// Surface Fitting with Splines", 1993): as few knots as the wanted residual needs, then the
// smoothest curve of exactly that residual.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "flowdlo/result.hpp"

namespace flowdlo::baselines {

/// [n] basis functions of degree 3 at `at`, for a knot vector of n + 4 whose ends are fourfold.
[[nodiscard]] Eigen::VectorXd cubic_basis(const std::vector<double>& knots, double at);

struct CubicSpline {
  std::vector<double> knots;     ///< [n + 4]
  Eigen::MatrixXd coefficients;  ///< [n, dimensions]

  [[nodiscard]] Eigen::VectorXd at(double parameter) const {
    return coefficients.transpose() * cubic_basis(knots, parameter);
  }
};

/// The spline over [0, 1] (parameter proportional to chord length) whose squared distances to
/// `points` sum to `smoothing` m^2, or less where a single cubic is that near. Fails with kBadInput
/// for fewer than 4 points, and where two in a row coincide.
[[nodiscard]] Result<CubicSpline> smoothing_spline(std::span<const Eigen::Vector3d> points,
                                                   double smoothing);

/// The least-squares spline of `pieces` even pieces through `points` [m, d] at `parameters` [m] in
/// [0, 1]. Where points are fewer than coefficients, the one of the smallest coefficients.
[[nodiscard]] CubicSpline least_squares_spline(const Eigen::MatrixXd& points,
                                               const std::vector<double>& parameters, int pieces);

}  // namespace flowdlo::baselines
