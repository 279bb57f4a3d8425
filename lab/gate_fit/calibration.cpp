#include "gate_fit/calibration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

#include "gate_fit/fit.hpp"
#include "gate_fit/folds.hpp"
#include "gate_fit/network_fit.hpp"

namespace flowdlo::lab {
namespace {

constexpr double kClosenessRidge = 1e-3;
constexpr int kClosenessSteps = 300;
constexpr double kErrorRidge = 1e-3;
constexpr int kErrorSteps = 500;
constexpr std::size_t kErrorStride = 4;
constexpr std::size_t kNodeStep = 4;  // neighbours tell the same
constexpr double kLeastError_m = 1e-5;
constexpr double kOneSigma = 0.68;
constexpr double kTwoSigma = 0.95;
constexpr double kTooNarrow = 1.25;  // what is missed by it counts that much more
constexpr int kHalvings = 20;
constexpr int kOddsSteps = 20;
constexpr double kOddsFloor = 1e-3;
// What every node is said to be off at first: log metres, the log odds of being elsewhere, and the
// logs of both spreads.
constexpr std::array<double, gate::NodeError::kNumbers> kErrorAtFirst{-6.5, -3.5, -1, -0.7, -0.7};

using Closeness = decltype(gate::GateWeights::closeness);
using ErrorNetwork = decltype(gate::GateWeights::node_error);

std::size_t chosen(const Outcome& outcome) { return outcome.returned[outcome.hypothesis]; }

auto closeness_features(const GateSample& sample, const Outcome& outcome) {
  return gate::closeness_features(sample.candidates, chosen(outcome), outcome.lead);
}

bool is_close(const GateSample& sample, const Outcome& outcome) {
  return errors_m(sample)[chosen(outcome)] < gate::kCloseError_m;
}

/// Says the mean of what both say; the second has no bends. What looks like nothing in the training
/// scenes is left to no network alone.
Closeness between(Closeness bent, const Closeness& straight) {
  for (double& weight : bent.bent[0]) weight *= 0.5;
  for (std::size_t k = 0; k < gate::kClosenessFeatures; ++k) {
    bent.straight[0][k] = 0.5 * (bent.straight[0][k] + straight.straight[0][k]);
  }
  return bent;
}

Closeness fit_closeness(const std::vector<GateSample>& samples,
                        const std::vector<Outcome>& outcomes, const Indices& use) {
  NetworkTask task{.inputs = gate::kClosenessFeatures,
                   .outputs = 1,
                   .start = {0},
                   .ridge = kClosenessRidge,
                   .steps = kClosenessSteps};
  std::vector<double> close;
  for (const std::size_t s : use) {
    const auto features = closeness_features(samples[s], outcomes[s]);
    task.rows.insert(task.rows.end(), features.begin(), features.end());
    close.push_back(is_close(samples[s], outcomes[s]) ? 1 : 0);
  }
  task.slope = [&](std::size_t row, std::span<const double> said, std::span<double> slope) {
    slope[0] = 1 / (1 + std::exp(-said[0])) - close[row];
  };
  const auto bent = network_of<Closeness>(fit_network(task));
  task.bends = false;
  return between(bent, network_of<Closeness>(fit_network(task)));
}

/// A straight line through log odds that were said of unknown scenes, so that as many are close as
/// it says: slope and offset, by Newton's method.
std::array<double, 2> fit_odds(const std::vector<double>& said, const std::vector<double>& close) {
  std::array<double, 2> line{1, 0};
  for (int step = 0; step < kOddsSteps; ++step) {
    std::array<double, 2> gain{};
    double bend_slope = kOddsFloor;
    double bend_both = 0;
    double bend_offset = kOddsFloor;
    for (std::size_t s = 0; s < said.size(); ++s) {
      const double share = 1 / (1 + std::exp(-line[0] * said[s] - line[1]));
      const double bend = share * (1 - share);
      gain[0] += (close[s] - share) * said[s];
      gain[1] += close[s] - share;
      bend_slope += bend * said[s] * said[s];
      bend_both += bend * said[s];
      bend_offset += bend;
    }
    const double area = bend_slope * bend_offset - bend_both * bend_both;
    line[0] += (bend_offset * gain[0] - bend_both * gain[1]) / area;
    line[1] += (bend_slope * gain[1] - bend_both * gain[0]) / area;
  }
  return line;
}

void scale(Closeness& closeness, const std::array<double, 2>& line) {
  for (double& weight : closeness.bent[0]) weight *= line[0];
  for (double& weight : closeness.straight[0]) weight *= line[0];
  closeness.straight[0][0] += line[1];
}

/// Some nodes of one sample, and how far they are off.
struct NodeRows {
  std::vector<std::array<double, gate::kNodeFeatures>> features;
  std::vector<double> log_m;
};

/// None where several ropes lie in the mask.
NodeRows node_rows(const GateSample& sample, const Outcome& outcome, double probability,
                   std::size_t first) {
  if (sample.several) return {};
  const gate::NodeFeatures features(sample.candidates, outcome.returned, outcome.scores,
                                    outcome.hypothesis, probability);
  const auto off_m = node_errors_m(sample.answer(chosen(outcome)), sample.truth);
  NodeRows rows;
  for (std::size_t node = first % kNodeStep; node < kNodes; node += kNodeStep) {
    rows.features.push_back(features.of(node));
    rows.log_m.push_back(std::log(std::max(off_m[node], kLeastError_m)));
  }
  return rows;
}

ErrorNetwork fit_node_error(const std::vector<NodeRows>& nodes, const Indices& use) {
  NetworkTask task{.inputs = ErrorNetwork::kInputs,
                   .outputs = ErrorNetwork::kOutputs,
                   .hidden = ErrorNetwork::kHidden,
                   .start = {kErrorAtFirst.begin(), kErrorAtFirst.end()},
                   .ridge = kErrorRidge,
                   .steps = kErrorSteps,
                   .stride = kErrorStride};
  std::vector<double> log_m;
  for (const std::size_t s : use) {
    for (const auto& features : nodes[s].features) {
      task.rows.insert(task.rows.end(), features.begin(), features.end());
    }
    log_m.insert(log_m.end(), nodes[s].log_m.begin(), nodes[s].log_m.end());
  }
  task.slope = [&](std::size_t row, std::span<const double> said, std::span<double> slope) {
    std::array<double, gate::NodeError::kNumbers> numbers{};
    std::array<double, gate::NodeError::kNumbers> gain{};
    std::copy(said.begin(), said.end(), numbers.begin());
    (void)gate::NodeError(numbers).log_density(log_m[row], gain);
    for (std::size_t k = 0; k < gain.size(); ++k) slope[k] = -gain[k];
  };
  return network_of<ErrorNetwork>(fit_network(task));
}

/// By how much too many nodes are within one sigma_m and too few within two, as a balance; rises
/// with the share.
double excess(const std::vector<gate::NodeError>& errors, const std::vector<double>& log_m,
              double share) {
  double within_one = 0;
  double within_two = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double two_sigma = std::log(errors[i].quantile_m(share));
    within_one += log_m[i] <= two_sigma - std::log(2.0) ? 1 : 0;
    within_two += log_m[i] <= two_sigma ? 1 : 0;
  }
  const auto count = static_cast<double>(errors.size());
  return within_one / count - kOneSigma + kTooNarrow * (within_two / count - kTwoSigma);
}

double fit_sigma_share(const std::vector<NodeRows>& nodes, std::size_t counted) {
  std::vector<gate::NodeError> errors;
  std::vector<double> log_m;
  each_fold(nodes.size(), [&](const Indices& others, const Indices& own) {
    const ErrorNetwork network = fit_node_error(nodes, others);
    for (const std::size_t s : own) {
      if (s >= counted) continue;
      for (const auto& features : nodes[s].features) errors.emplace_back(network(features));
      log_m.insert(log_m.end(), nodes[s].log_m.begin(), nodes[s].log_m.end());
    }
  });
  double low = 0.5;
  double high = 0.999;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (excess(errors, log_m, middle) > 0 ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

void calibrate(const std::vector<GateSample>& samples, const std::vector<Outcome>& outcomes,
               std::size_t counted, gate::GateWeights& weights) {
  std::vector<double> said(samples.size());
  std::vector<double> close;
  for (std::size_t s = 0; s < samples.size(); ++s) {
    close.push_back(is_close(samples[s], outcomes[s]) ? 1 : 0);
  }
  each_fold(samples.size(), [&](const Indices& others, const Indices& own) {
    const Closeness closeness = fit_closeness(samples, outcomes, others);
    for (const std::size_t s : own) {
      said[s] = closeness(closeness_features(samples[s], outcomes[s])).front();
    }
  });
  const auto line = fit_odds(said, close);
  const Indices all = all_but(kFolds, samples.size());
  weights.closeness = fit_closeness(samples, outcomes, all);
  scale(weights.closeness, line);
  std::vector<NodeRows> nodes;
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const double probability = 1 / (1 + std::exp(-line[0] * said[s] - line[1]));
    nodes.push_back(node_rows(samples[s], outcomes[s], probability, s / kFolds));
  }
  weights.sigma_share = fit_sigma_share(nodes, counted);
  weights.node_error = fit_node_error(nodes, all);
}

}  // namespace flowdlo::lab
