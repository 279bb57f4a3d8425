// RopeOdds: how likely the estimate of one rope of several is close, by what tells of it: the fit
// behind estimator/rope_confidence.
#pragma once

#include <vector>

#include "estimator/rope_confidence.hpp"
#include "reports/ropes_outcome.hpp"

namespace flowdlo::lab {

/// An estimator's judge as the configuration has it. Fails as Estimator::create does, and where its
/// weights have no calibrated gate.
[[nodiscard]] Result<RopeJudge> open_judge(const Config& config);

class RopeOdds {
 public:
  /// Every rope that was found, where a judge saw it.
  void add(const RopesOutcome& outcome);

  /// The most likely log odds, for each witness and for rings; nothing without ropes.
  void print() const;

 private:
  struct Row {
    estimator::Witness witness{};
    double lead = 0;
    double own = 0;
    bool closed = false;
    bool close = false;
  };
  std::vector<Row> rows_;
};

}  // namespace flowdlo::lab
