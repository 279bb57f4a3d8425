// NetworkFit: the weights of a gate::Network, by steepest descent with momentum.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "gate/network.hpp"
#include "weights/section.hpp"

namespace flowdlo::lab {

/// A network of any size, as a fit sees it.
struct NetworkWeights {
  std::vector<double> hidden;    ///< [hidden, inputs]
  std::vector<double> bent;      ///< [outputs, hidden]
  std::vector<double> straight;  ///< [outputs, inputs]
};

struct NetworkTask {
  std::size_t inputs = 0;  ///< features of a row; the first of each is one
  std::size_t outputs = 0;
  std::size_t hidden = 8;
  std::uint64_t seed = 1;      ///< of the weights that the descent sets out from
  std::vector<double> rows{};  ///< [rows, inputs]
  std::vector<double> start;   ///< [outputs] what is said of every row at first
  double ridge = 0;            ///< penalty of squared weights of standardised features, a row
  int steps = 0;
  double rate = 0.02;      ///< of a weight, in one step; falls to nothing
  bool bends = true;       ///< false: the straight way alone
  std::size_t stride = 1;  ///< each step takes every so many-th row, in turn
  /// Fills what the loss of that row rises by with each output.
  std::function<void(std::size_t row, std::span<const double> said, std::span<double> slope)>
      slope{};
  /// In its place, where the rows' losses hang together: the same for all rows of a batch at once,
  /// both [rows, outputs]. The stride is then 1.
  std::function<void(std::size_t batch, std::span<const double> said, std::span<double> slope)>
      slopes{};
  /// The rows' numbers in each batch, which together are all, in order; each step takes one, in
  /// turn. Empty: all rows are one batch.
  std::vector<std::size_t> batches{};
};

/// The same for the same task. Expects at least one row.
[[nodiscard]] NetworkWeights fit_network(const NetworkTask& task);

/// One network that says the mean of what `count` say, each fitted from a seed of its own: their
/// hidden weights are one below another.
[[nodiscard]] NetworkWeights fit_mean_of_networks(NetworkTask task, int count);

/// One of one output as a section of a weights file, whose manifest is a bent network's.
[[nodiscard]] weights::Section section_of(const NetworkWeights& fitted,
                                          const std::vector<weights::Expected>& manifest);

template <class Network>
[[nodiscard]] Network network_of(const NetworkWeights& weights) {
  Network network;
  const auto copy = [](const std::vector<double>& from, auto& to) {
    auto next = from.begin();
    for (auto& row : to) {
      std::copy_n(next, row.size(), row.begin());
      next += static_cast<std::ptrdiff_t>(row.size());
    }
  };
  copy(weights.hidden, network.hidden);
  copy(weights.bent, network.bent);
  copy(weights.straight, network.straight);
  return network;
}

}  // namespace flowdlo::lab
