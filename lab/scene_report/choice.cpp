#include "scene_report/choice.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace flowdlo::lab {
namespace {

constexpr int kMostSteps = 60;
constexpr double kMostStep = 5;
constexpr double kSettled = 1e-9;

using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<double> chances(const Choice& choice, const VectorXd& weights) {
  std::vector<double> utility;
  for (const auto& row : choice.rows) {
    utility.push_back(weights.dot(Map<const VectorXd>(row.data(), weights.size())));
  }
  const double most = *std::max_element(utility.begin(), utility.end());
  double sum = 0;
  for (double& value : utility) sum += value = std::exp(value - most);
  for (double& value : utility) value /= sum;
  return utility;
}

}  // namespace

std::vector<double> fit(const std::vector<Choice>& choices, std::size_t features, double ridge) {
  const auto size = static_cast<Eigen::Index>(features);
  VectorXd weights = VectorXd::Zero(size);
  for (int step = 0; step < kMostSteps; ++step) {
    VectorXd gradient = -ridge * weights;
    MatrixXd curvature = ridge * MatrixXd::Identity(size, size);
    for (const Choice& choice : choices) {
      const auto chance = chances(choice, weights);
      VectorXd mean = VectorXd::Zero(size);
      for (std::size_t i = 0; i < chance.size(); ++i) {
        mean += chance[i] * Map<const VectorXd>(choice.rows[i].data(), size);
      }
      gradient +=
          choice.weight * (Map<const VectorXd>(choice.rows[choice.right].data(), size) - mean);
      for (std::size_t i = 0; i < chance.size(); ++i) {
        const VectorXd off = Map<const VectorXd>(choice.rows[i].data(), size) - mean;
        curvature += choice.weight * chance[i] * off * off.transpose();
      }
    }
    VectorXd change = curvature.ldlt().solve(gradient);
    const double length = change.norm();
    if (length > kMostStep) change *= kMostStep / length;
    weights += change;
    if (length < kSettled) break;
  }
  return {weights.data(), weights.data() + size};
}

}  // namespace flowdlo::lab
