// NodeFeatures: what tells how far the nodes of a chosen candidate may be off. None of it needs the
// model, so that constants fitted on frames without one hold for frames with one.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "gate/candidate.hpp"

namespace flowdlo::gate {

inline constexpr std::size_t kNodeFeatures = 39;

class NodeFeatures {
 public:
  /// `returned` and `scores` [hypotheses] are what each hypothesis would return and its score,
  /// `chosen` the index of the one that is taken, `probability` how likely it is close.
  NodeFeatures(std::span<const Candidate> candidates, std::span<const std::size_t> returned,
               std::span<const double> scores, std::size_t chosen, double probability);

  /// The first is one; logarithms of lengths are relative to a few millimetres.
  [[nodiscard]] std::array<double, kNodeFeatures> of(std::size_t node) const;

 private:
  void measure_rivals(std::span<const Candidate> candidates, std::span<const std::size_t> returned,
                      std::span<const double> scores, std::size_t chosen);
  void describe_frame(const Candidate& prior, double probability);

  const Candidate& candidate_;
  std::array<double, kNodes> sigma_m_{};     ///< the prior's own
  std::array<double, kNodes> spread_m_{};    ///< of the rivals around each node, weighed by odds
  std::array<double, kNodes> voted_m_{};     ///< the same, weighed by what the readings hold
  std::array<double, kNodes> furthest_m_{};  ///< rival of each node
  double rivals_odds_ = 0;                   ///< [0, 1] that one of them is right, by score alone
  bool alone_ = true;
  std::array<double, kNodeFeatures> frame_{};  ///< the row, where it is the same for all nodes
};

}  // namespace flowdlo::gate
