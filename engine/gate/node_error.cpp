#include "gate/node_error.hpp"

#include <algorithm>
#include <cmath>

namespace flowdlo::gate {
namespace {

constexpr double kLeastLogSpread = -2;
constexpr double kMostLogSpread = 1;
constexpr double kLeastDensity = 1e-12;
constexpr int kHalvings = 30;

double logistic(double x) { return 1 / (1 + std::exp(-x)); }

}  // namespace

NodeError::NodeError(const std::array<double, kNumbers>& said) {
  const double elsewhere = logistic(said[2]);
  for (std::size_t k = 0; k < 2; ++k) {
    const double log_spread = std::clamp(said[3 + k], kLeastLogSpread, kMostLogSpread);
    parts_[k] = {k == 0 ? 1 - elsewhere : elsewhere, said[k], std::exp(log_spread),
                 log_spread == said[3 + k]};
  }
}

double NodeError::within(double log_m) const {
  double share = 0;
  for (const Part& part : parts_) {
    share += part.weight * logistic((log_m - part.log_m) / part.spread);
  }
  return share;
}

double NodeError::log_density(double log_m, std::array<double, kNumbers>& slope) const {
  std::array<double, 2> density{};
  std::array<double, 2> off{};
  std::array<double, 2> below{};
  for (std::size_t k = 0; k < 2; ++k) {
    off[k] = (log_m - parts_[k].log_m) / parts_[k].spread;
    below[k] = logistic(off[k]);
    density[k] = parts_[k].weight * below[k] * (1 - below[k]) / parts_[k].spread + kLeastDensity;
  }
  const double sum = density[0] + density[1];
  for (std::size_t k = 0; k < 2; ++k) {
    const double part = density[k] / sum;
    const double pull = 2 * below[k] - 1;
    slope[k] = part * pull / parts_[k].spread;
    slope[3 + k] = parts_[k].free ? part * (off[k] * pull - 1) : 0;
  }
  slope[2] = density[1] / sum - parts_[1].weight;
  return std::log(sum);
}

double NodeError::quantile_m(double share) const {
  double low = std::log(kLeast_m);
  double high = std::log(kMost_m);
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (within(middle) >= share ? high : low) = middle;
  }
  return std::exp(high);
}

}  // namespace flowdlo::gate
