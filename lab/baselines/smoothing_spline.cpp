#include "baselines/smoothing_spline.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace flowdlo::baselines {
namespace {

constexpr int kDegree = 3;
constexpr int kOrder = kDegree + 1;
constexpr double kTolerance = 1e-3;  // of the wanted residual
constexpr int kMostHalvings = 60;

struct Fit {
  Eigen::MatrixXd coefficients;  // [n, d]
  Eigen::VectorXd residuals;     // [m] squared
  [[nodiscard]] double sum() const { return residuals.sum(); }
};

// Breakpoints inside (0, 1), and how many data points lie strictly between each two.
struct Knots {
  std::vector<double> inner;
  std::vector<int> points_between;

  [[nodiscard]] std::vector<double> full() const {
    std::vector<double> knots(kOrder, 0.0);
    knots.insert(knots.end(), inner.begin(), inner.end());
    knots.insert(knots.end(), kOrder, 1.0);
    return knots;
  }
};

Eigen::MatrixXd basis_matrix(const std::vector<double>& knots, const std::vector<double>& at) {
  Eigen::MatrixXd basis(static_cast<Eigen::Index>(at.size()),
                        static_cast<Eigen::Index>(knots.size()) - kOrder);
  for (std::size_t i = 0; i < at.size(); ++i) {
    basis.row(static_cast<Eigen::Index>(i)) = cubic_basis(knots, at[i]).transpose();
  }
  return basis;
}

Fit solve(const Eigen::MatrixXd& basis, const Eigen::MatrixXd& points,
          const Eigen::MatrixXd& jumps) {
  Eigen::MatrixXd left(basis.rows() + jumps.rows(), basis.cols());
  left << basis, jumps;
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(left.rows(), points.cols());
  right.topRows(points.rows()) = points;
  Fit fit;
  fit.coefficients = left.completeOrthogonalDecomposition().solve(right);
  fit.residuals = (basis * fit.coefficients - points).rowwise().squaredNorm();
  return fit;
}

// [inner knots, n] jump of the third derivative at each inner knot, per coefficient.
Eigen::MatrixXd derivative_jumps(const std::vector<double>& knots) {
  const std::size_t count = knots.size() - kOrder;
  const std::size_t inner = knots.size() - 2 * kOrder;
  Eigen::MatrixXd jumps =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(inner), static_cast<Eigen::Index>(count));
  // B_i is the divided difference over its five knots of (x - u)^3_+: the jump at a knot is that
  // knot's weight in it.
  for (std::size_t r = 0; r < inner; ++r) {
    const std::size_t knot = kOrder + r;
    for (std::size_t i = knot - kOrder; i <= knot && i < count; ++i) {
      double weight = knots[i + kOrder] - knots[i];
      for (std::size_t j = i; j <= i + kOrder; ++j) {
        if (j != knot) weight /= knots[knot] - knots[j];
      }
      jumps(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(i)) = weight;
    }
  }
  return jumps / std::max(1.0, jumps.cwiseAbs().maxCoeff());
}

// Squared residuals of each interval; a point on a knot counts half on either side.
std::vector<double> interval_residuals(const Knots& knots, const std::vector<double>& at,
                                       const Eigen::VectorXd& residuals) {
  std::vector<double> sums(knots.inner.size() + 1, 0.0);
  std::size_t k = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double residual = residuals(static_cast<Eigen::Index>(i));
    if (k < knots.inner.size() && at[i] >= knots.inner[k]) {
      sums[k] += residual / 2;
      sums[++k] += residual / 2;
    } else {
      sums[k] += residual;
    }
  }
  return sums;
}

// A knot on the middle point of the interval of the largest residual; false where none has room.
bool add_knot(Knots& knots, const std::vector<double>& at, std::vector<double>& sums) {
  std::size_t worst = sums.size();
  int first = 0;  // index of the point at which the worst interval begins
  int begin = 0;
  for (std::size_t j = 0; j < sums.size(); ++j) {
    const int between = knots.points_between[j];
    if (between > 0 && (worst == sums.size() || sums[j] > sums[worst])) {
      worst = j;
      first = begin;
    }
    begin += between + 1;
  }
  if (worst == sums.size()) return false;
  const int between = knots.points_between[worst];
  const int half = between / 2 + 1;
  const double value = at[static_cast<std::size_t>(first + half)];
  const auto place = static_cast<std::ptrdiff_t>(worst);
  const double sum = sums[worst];
  knots.inner.insert(knots.inner.begin() + place, value);
  knots.points_between[worst] = half - 1;
  knots.points_between.insert(knots.points_between.begin() + place + 1, between - half);
  sums[worst] = sum * (half - 1) / between;
  sums.insert(sums.begin() + place + 1, sum * (between - half) / between);
  return true;
}

// How many knots to add next, from what the last ones achieved.
int knots_to_add(int before, double last, double now, double smoothing) {
  int wanted = 2 * before;
  if (last - now > kTolerance * smoothing) {
    wanted = static_cast<int>(before * (now - smoothing) / (last - now));
  }
  return std::min(2 * before, std::max({wanted, before / 2, 1}));
}

// The smoothest spline on `knots` whose residual is `smoothing`: a bisection over the weight of the
// jumps, as the residual grows with it. `tight` is the fit without them.
Eigen::MatrixXd smoothest(const std::vector<double>& knots, const Eigen::MatrixXd& basis,
                          const Eigen::MatrixXd& points, Fit tight, double smoothing) {
  const Eigen::MatrixXd jumps = derivative_jumps(knots);
  double low = -12;  // decimal logarithms of the weight
  double high = 12;
  Fit best = std::move(tight);
  for (int i = 0; i < kMostHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    Fit fit = solve(basis, points, std::pow(10.0, middle) * jumps);
    const double off = fit.sum() - smoothing;
    (off > 0 ? high : low) = middle;
    best = std::move(fit);
    if (std::abs(off) < kTolerance * smoothing) break;
  }
  return best.coefficients;
}

Result<std::vector<double>> chord_parameters(std::span<const Eigen::Vector3d> points) {
  if (points.size() < kOrder) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("smoothing_spline: expected 4 points or more, got {}", points.size())};
  }
  std::vector<double> along{0.0};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double chord = (points[i] - points[i - 1]).norm();
    if (!(chord > 0)) {
      return Error{ErrorCode::kBadInput, "smoothing_spline: two points in a row coincide"};
    }
    along.push_back(along.back() + chord);
  }
  const double length = along.back();
  for (double& value : along) value /= length;
  along.back() = 1;
  return along;
}

}  // namespace

Eigen::VectorXd cubic_basis(const std::vector<double>& knots, double at) {
  const std::size_t count = knots.size() - kOrder;
  at = std::clamp(at, knots.front(), knots.back());
  std::size_t span = kDegree;
  while (span + 1 < count && at >= knots[span + 1]) ++span;
  double values[kOrder] = {1, 0, 0, 0};
  for (std::size_t degree = 1; degree <= kDegree; ++degree) {  // de Boor and Cox
    double saved = 0;
    for (std::size_t r = 0; r < degree; ++r) {
      const double right = knots[span + r + 1];
      const double left = knots[span + 1 + r - degree];
      const double share = right > left ? values[r] / (right - left) : 0;
      values[r] = saved + (right - at) * share;
      saved = (at - left) * share;
    }
    values[degree] = saved;
  }
  Eigen::VectorXd basis = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count));
  for (std::size_t r = 0; r < kOrder; ++r) {
    basis(static_cast<Eigen::Index>(span - kDegree + r)) = values[r];
  }
  return basis;
}

Result<CubicSpline> smoothing_spline(std::span<const Eigen::Vector3d> points, double smoothing) {
  const auto at = chord_parameters(points);
  if (!at) return at.error();
  const auto count = static_cast<int>(points.size());
  Eigen::MatrixXd rows(count, 3);
  for (int i = 0; i < count; ++i) rows.row(i) = points[static_cast<std::size_t>(i)].transpose();
  Knots knots{{}, {count - 2}};
  int added = 1;
  double last = 0;
  for (;;) {
    const Eigen::MatrixXd basis = basis_matrix(knots.full(), *at);
    Fit fit = solve(basis, rows, Eigen::MatrixXd(0, basis.cols()));
    const double sum = fit.sum();
    const bool enough = sum - smoothing < kTolerance * smoothing;
    if (enough && (knots.inner.empty() || sum > (1 - kTolerance) * smoothing)) {
      return CubicSpline{knots.full(), std::move(fit.coefficients)};
    }
    const bool full = static_cast<int>(knots.inner.size()) + kOrder >= count;
    if (enough || full) {
      auto coefficients = smoothest(knots.full(), basis, rows, std::move(fit), smoothing);
      return CubicSpline{knots.full(), std::move(coefficients)};
    }
    if (!knots.inner.empty()) added = knots_to_add(added, last, sum, smoothing);
    last = sum;
    auto sums = interval_residuals(knots, *at, fit.residuals);
    for (int i = 0; i < added; ++i) {
      if (static_cast<int>(knots.inner.size()) + kOrder >= count) break;
      if (!add_knot(knots, *at, sums)) break;
    }
  }
}

CubicSpline least_squares_spline(const Eigen::MatrixXd& points,
                                 const std::vector<double>& parameters, int pieces) {
  Knots knots;
  for (int i = 1; i < pieces; ++i) knots.inner.push_back(static_cast<double>(i) / pieces);
  const Eigen::MatrixXd basis = basis_matrix(knots.full(), parameters);
  return {knots.full(), solve(basis, points, Eigen::MatrixXd(0, basis.cols())).coefficients};
}

}  // namespace flowdlo::baselines
