#include "baselines/smoothing_spline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace flowdlo::baselines {
namespace {

using testing::HasSubstr;
using Points = std::vector<Eigen::Vector3d>;

// A wave half a metre long with a ripple of `noise` on it.
Points wave(int count, double noise) {
  Points points;
  for (int i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / (count - 1);
    points.emplace_back(0.5 * t, 0.1 * std::sin(9 * t) + noise * (i % 2 == 0 ? 1 : -1), 0.5);
  }
  return points;
}

double residual(const CubicSpline& spline, const Points& points) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  double along = 0;
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0) along += (points[i] - points[i - 1]).norm();
    sum += (spline.at(along / length) - points[i]).squaredNorm();
  }
  return sum;
}

TEST(CubicBasis, SumsToOneEverywhere) {
  const std::vector<double> knots{0, 0, 0, 0, 0.3, 0.5, 1, 1, 1, 1};
  for (const double at : {0.0, 0.1, 0.3, 0.5, 0.99, 1.0}) {
    EXPECT_NEAR(cubic_basis(knots, at).sum(), 1, 1e-12) << at;
  }
}

TEST(SmoothingSpline, LeavesExactlyTheResidualAskedFor) {
  const Points points = wave(80, 0.004);
  const auto spline = smoothing_spline(points, 0.0005);
  ASSERT_TRUE(spline) << spline.error().message;
  EXPECT_GT(spline->knots.size(), 8U);
  EXPECT_NEAR(residual(*spline, points), 0.0005, 1e-6);
}

TEST(SmoothingSpline, IsASingleCubicWhereThatIsNearEnough) {
  const auto spline = smoothing_spline(wave(30, 0), 10);
  ASSERT_TRUE(spline);
  EXPECT_EQ(spline->knots.size(), 8U);
}

TEST(SmoothingSpline, PassesThroughThePointsWhereNothingMayBeLeft) {
  const Points points = wave(20, 0.01);
  const auto spline = smoothing_spline(points, 1e-12);
  ASSERT_TRUE(spline);
  EXPECT_LT(residual(*spline, points), 1e-6);
}

TEST(SmoothingSpline, NeedsFourPoints) {
  const auto spline = smoothing_spline(wave(3, 0), 1);
  ASSERT_FALSE(spline);
  EXPECT_THAT(spline.error().message, HasSubstr("4 points"));
}

TEST(SmoothingSpline, RefusesPointsThatRepeat) {
  Points points = wave(10, 0);
  points[4] = points[3];
  const auto spline = smoothing_spline(points, 1);
  ASSERT_FALSE(spline);
  EXPECT_THAT(spline.error().message, HasSubstr("coincide"));
}

TEST(LeastSquaresSpline, FollowsALine) {
  Eigen::MatrixXd points(20, 2);
  std::vector<double> parameters;
  for (int i = 0; i < 20; ++i) {
    parameters.push_back(i / 19.0);
    points.row(i) << 3.0 * i, 50.0 - i;
  }
  const auto spline = least_squares_spline(points, parameters, 5);
  EXPECT_NEAR(spline.at(0.5).x(), 28.5, 1e-6);
  EXPECT_NEAR(spline.at(0.5).y(), 40.5, 1e-6);
}

}  // namespace
}  // namespace flowdlo::baselines
