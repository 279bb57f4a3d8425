#include "gate_fit/network_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace flowdlo::lab {
namespace {

using Net = gate::Network<3, 1>;

/// Least squares over rows of one and two uniform numbers.
template <class Network = Net, class Truth>
Network fitted(const Truth& truth, double ridge) {
  std::mt19937_64 engine(3);
  NetworkTask task{.inputs = 3,
                   .outputs = 1,
                   .hidden = Network::kHidden,
                   .start = {0},
                   .ridge = ridge,
                   .steps = 800};
  std::vector<double> wanted;
  for (int i = 0; i < 1000; ++i) {
    const auto uniform = [&] { return static_cast<double>(engine() >> 11) / 4503599627370496 - 1; };
    const double a = uniform();
    const double b = 5 + 3 * uniform();
    task.rows.insert(task.rows.end(), {1, a, b});
    wanted.push_back(truth(a, b));
  }
  task.slope = [&](std::size_t row, std::span<const double> said, std::span<double> slope) {
    slope[0] = said[0] - wanted[row];
  };
  return network_of<Network>(fit_network(task));
}

TEST(FitNetwork, FindsAPlane) {
  const auto plane = [](double a, double b) { return 0.3 + 2 * a - 0.5 * b; };
  const Net network = fitted(plane, 0);
  for (const double a : {-0.8, 0.0, 0.7}) {
    EXPECT_NEAR(network({1, a, 4})[0], plane(a, 4), 0.05);
  }
}

TEST(FitNetwork, FindsABend) {
  const auto bend = [](double a, double) { return std::abs(a); };
  const Net network = fitted(bend, 0);
  for (const double a : {-0.8, -0.4, 0.4, 0.8}) {
    EXPECT_NEAR(network({1, a, 5})[0], std::abs(a), 0.1);
  }
}

TEST(FitNetwork, MoreHiddenUnitsFollowAWave) {
  const auto wave = [](double a, double) { return std::sin(5 * a); };
  const auto worst = [&](const auto& network) {
    double off = 0;
    for (double a = -0.9; a <= 0.9; a += 0.1) {
      off = std::max(off, std::abs(network({1, a, 5})[0] - wave(a, 5)));
    }
    return off;
  };
  const double few = worst(fitted<gate::Network<3, 1, 1>>(wave, 0));
  EXPECT_LT(worst(fitted<gate::Network<3, 1, 16>>(wave, 0)), 0.5 * few);
}

TEST(FitNetwork, ARidgeKeepsWeightsSmall) {
  const auto plane = [](double a, double b) { return 2 * a - 0.5 * b; };
  EXPECT_LT(std::abs(fitted(plane, 1).straight[0][1]), std::abs(fitted(plane, 0).straight[0][1]));
}

}  // namespace
}  // namespace flowdlo::lab
