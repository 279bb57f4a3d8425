#include "survey/choice_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace flowdlo::survey {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostSteps = 60;
constexpr double kLeastScale = 1e-4;    // of a step
constexpr double kSettled = 1e-9;       // of the loss
constexpr double kLeastChance = 1e-12;  // so that its logarithm is finite

VectorXd chances(const Choice& choice, const VectorXd& weights) {
  VectorXd utility = choice.rows * weights;
  utility = (utility.array() - utility.maxCoeff()).exp();
  return utility / utility.sum();
}

double unlikely(const Choice& choice, const VectorXd& chance) {
  return -std::log(std::max(chance[choice.right], kLeastChance));
}

double loss_of(const std::vector<Choice>& choices, const VectorXd& weights, double ridge) {
  double loss = 0.5 * ridge * weights.squaredNorm();
  for (const Choice& choice : choices) {
    loss += choice.weight * unlikely(choice, chances(choice, weights));
  }
  return loss;
}

/// Newton's step down.
VectorXd step_of(const std::vector<Choice>& choices, const VectorXd& weights, double ridge,
                 const std::vector<bool>& fixed) {
  VectorXd gradient = ridge * weights;
  MatrixXd curvature = ridge * MatrixXd::Identity(weights.size(), weights.size());
  for (const Choice& choice : choices) {
    const VectorXd chance = chances(choice, weights);
    const VectorXd mean = choice.rows.transpose() * chance;
    const MatrixXd off = choice.rows.rowwise() - mean.transpose();
    gradient += choice.weight * (mean - choice.rows.row(choice.right).transpose());
    curvature += choice.weight * off.transpose() * chance.asDiagonal() * off;
  }
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (!fixed[i]) continue;
    const auto k = static_cast<Eigen::Index>(i);
    gradient[k] = 0;
    curvature.row(k).setZero();
    curvature.col(k).setZero();
    curvature(k, k) = 1;
  }
  return -curvature.ldlt().solve(gradient);
}

}  // namespace

VectorXd fit(const std::vector<Choice>& choices, Eigen::Index features, double ridge,
             const std::vector<bool>& fixed) {
  VectorXd weights = VectorXd::Zero(features);
  double loss = loss_of(choices, weights, ridge);
  for (int round = 0; round < kMostSteps; ++round) {
    const VectorXd step = step_of(choices, weights, ridge, fixed);
    double scale = 1;
    double next = loss;
    for (; scale > kLeastScale; scale *= 0.5) {
      next = loss_of(choices, weights + scale * step, ridge);
      if (next < loss) break;
    }
    if (scale <= kLeastScale) break;
    weights += scale * step;
    if (loss - next < kSettled * loss) break;
    loss = next;
  }
  return weights;
}

FitQuality quality_of(const std::vector<Choice>& choices, const VectorXd& weights) {
  FitQuality quality;
  const double share = 1.0 / static_cast<double>(std::max<std::size_t>(1, choices.size()));
  for (const Choice& choice : choices) {
    const VectorXd chance = chances(choice, weights);
    quality.unlikely += share * unlikely(choice, chance);
    quality.right += chance.maxCoeff() <= chance[choice.right] ? share : 0;
  }
  return quality;
}

}  // namespace flowdlo::survey
