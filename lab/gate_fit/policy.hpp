// Policy: scores fitted so that taking the best of each group costs least.
#pragma once

#include <cstddef>
#include <vector>

#include "gate_fit/network_fit.hpp"

namespace flowdlo::lab {

/// Rows of features of which one has to be taken, and what taking it costs.
struct Group {
  std::vector<std::vector<double>> rows;  ///< [rows, features]
  std::vector<double> costs;              ///< [rows]
};

/// [features] weights of least expected cost where row i is taken with a probability proportional
/// to exp(weights . row), under a ridge penalty; from `start`, by steepest descent with momentum.
[[nodiscard]] std::vector<double> fit_policy(const std::vector<Group>& groups,
                                             std::vector<double> start, double ridge);

/// The same of the mean of `networks` with one output each. `ridge` is that of NetworkTask; the
/// first feature of each row is one. Expects at least one group.
[[nodiscard]] NetworkWeights fit_policy_network(const std::vector<Group>& groups, double ridge,
                                                int steps, int networks);

}  // namespace flowdlo::lab
