#include "gate_fit/quantile.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

namespace flowdlo::lab {
namespace {

using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostSteps = 40;
constexpr double kSettled = 1e-7;
constexpr double kSoftness = 0.15;  // of the step at a quantile, in logarithms
constexpr double kMostStep = 1;

struct Quantile {
  double share;
  double offset;  // of the log scale
};
constexpr std::array<Quantile, 2> kQuantiles{{{0.68, 0}, {0.95, 0.6931471805599453}}};

}  // namespace

std::vector<double> fit_scale(const std::vector<ScaleRow>& rows, double ridge) {
  const auto size = static_cast<Eigen::Index>(rows.front().features.size());
  const double part = 1 / static_cast<double>(rows.size());
  VectorXd weights = VectorXd::Zero(size);
  double mean = 0;
  for (const ScaleRow& row : rows) mean += part * row.log_value;
  weights[0] = mean;
  for (int step = 0; step < kMostSteps; ++step) {
    VectorXd gradient = -ridge * weights;
    MatrixXd curvature = MatrixXd::Identity(size, size) * std::max(ridge, 1e-9);
    gradient[0] = 0;
    for (const ScaleRow& row : rows) {
      const Map<const VectorXd> features(row.features.data(), size);
      const double off = row.log_value - features.dot(weights);
      double slope = 0;
      double bend = 0;
      for (const Quantile& quantile : kQuantiles) {
        const double below = 1 / (1 + std::exp((off - quantile.offset) / kSoftness));
        slope += quantile.share - below;
        // A logistic step has no slope far away; a floor keeps Newton's steps short there.
        bend += std::max(below * (1 - below), 0.05) / kSoftness;
      }
      gradient += part * slope * features;
      curvature.selfadjointView<Eigen::Lower>().rankUpdate(features, part * bend);
    }
    VectorXd change = curvature.selfadjointView<Eigen::Lower>().ldlt().solve(gradient);
    const double length = change.norm();
    if (length > kMostStep) change *= kMostStep / length;
    weights += change;
    if (length < kSettled) break;
  }
  return {weights.data(), weights.data() + size};
}

}  // namespace flowdlo::lab
