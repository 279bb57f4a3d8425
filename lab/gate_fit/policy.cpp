#include "gate_fit/policy.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

namespace flowdlo::lab {
namespace {

constexpr int kSteps = 600;
constexpr double kRate = 0.05;       // of a weight, in one step; falls to nothing
constexpr double kMomentum = 0.9;    // of the mean slope
constexpr double kSmoothing = 0.99;  // of the mean squared slope
constexpr double kLeastSlope = 1e-8;

/// [rows] what a group's expected cost rises by with each row's score.
std::vector<double> cost_slope(std::vector<double> scores, const std::vector<double>& costs) {
  const double most = *std::max_element(scores.begin(), scores.end());
  double sum = 0;
  for (double& value : scores) sum += value = std::exp(value - most);
  double mean = 0;
  for (std::size_t i = 0; i < scores.size(); ++i) mean += (scores[i] /= sum) * costs[i];
  for (std::size_t i = 0; i < scores.size(); ++i) scores[i] *= costs[i] - mean;
  return scores;
}

/// Adds what one group's expected cost rises by with each weight.
void add_slope(const Group& group, const std::vector<double>& weights, std::vector<double>& slope) {
  std::vector<double> scores;
  for (const auto& row : group.rows) {
    scores.push_back(std::inner_product(row.begin(), row.end(), weights.begin(), 0.0));
  }
  const auto factors = cost_slope(std::move(scores), group.costs);
  for (std::size_t i = 0; i < factors.size(); ++i) {
    for (std::size_t k = 0; k < slope.size(); ++k) slope[k] += factors[i] * group.rows[i][k];
  }
}

}  // namespace

std::vector<double> fit_policy(const std::vector<Group>& groups, std::vector<double> start,
                               double ridge) {
  std::vector<double>& weights = start;
  std::vector<double> mean(weights.size(), 0);
  std::vector<double> square(weights.size(), 0);
  for (int step = 1; step <= kSteps; ++step) {
    std::vector<double> slope;
    for (const double weight : weights) slope.push_back(2 * ridge * weight);
    for (const Group& group : groups) add_slope(group, weights, slope);
    const double rate = kRate * (1 - static_cast<double>(step - 1) / kSteps);
    for (std::size_t k = 0; k < weights.size(); ++k) {
      mean[k] = kMomentum * mean[k] + (1 - kMomentum) * slope[k];
      square[k] = kSmoothing * square[k] + (1 - kSmoothing) * slope[k] * slope[k];
      const double centred = mean[k] / (1 - std::pow(kMomentum, step));
      const double size = std::sqrt(square[k] / (1 - std::pow(kSmoothing, step)));
      weights[k] -= rate * centred / (size + kLeastSlope);
    }
  }
  return start;
}

NetworkWeights fit_policy_network(const std::vector<Group>& groups, double ridge, int steps,
                                  int networks) {
  NetworkTask task{.inputs = groups.front().rows.front().size(),
                   .outputs = 1,
                   .start = {0},
                   .ridge = ridge,
                   .steps = steps};
  for (const Group& group : groups) {
    for (const auto& row : group.rows) task.rows.insert(task.rows.end(), row.begin(), row.end());
  }
  task.slopes = [&](std::size_t, std::span<const double> said, std::span<double> slope) {
    std::size_t first = 0;
    for (const Group& group : groups) {
      const auto scores = said.subspan(first, group.rows.size());
      const auto rises = cost_slope({scores.begin(), scores.end()}, group.costs);
      std::copy(rises.begin(), rises.end(), slope.begin() + static_cast<std::ptrdiff_t>(first));
      first += group.rows.size();
    }
  };
  return fit_mean_of_networks(task, networks);
}

}  // namespace flowdlo::lab
