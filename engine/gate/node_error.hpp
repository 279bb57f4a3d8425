// NodeError: how far a node may be off, as a mixture of two log-logistic distances: that of a node
// on the right strand, and that of a node which is elsewhere.
#pragma once

#include <array>
#include <cstddef>

namespace flowdlo::gate {

class NodeError {
 public:
  /// What a network says: log metres of both medians, the log odds of being elsewhere, and the logs
  /// of both spreads.
  static constexpr std::size_t kNumbers = 5;
  explicit NodeError(const std::array<double, kNumbers>& said);

  /// In [0, 1]: the probability that the node is off by less than exp(log_m).
  [[nodiscard]] double within(double log_m) const;

  /// Natural logarithm of its density over the logarithm of the distance. Its slope over what was
  /// said goes to `slope`.
  [[nodiscard]] double log_density(double log_m, std::array<double, kNumbers>& slope) const;

  /// The distance in metres that it is within with this probability, from kLeast_m to kMost_m;
  /// kMost_m where something said is not finite.
  [[nodiscard]] double quantile_m(double share) const;

  static constexpr double kLeast_m = 2e-5;
  static constexpr double kMost_m = 10;

 private:
  struct Part {
    double weight = 0;
    double log_m = 0;
    double spread = 1;
    bool free = true;  ///< its spread is not at a bound
  };
  std::array<Part, 2> parts_;
};

}  // namespace flowdlo::gate
