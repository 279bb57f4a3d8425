// Calibration: how likely what the gate takes is close, and how far its nodes may be off.
#pragma once

#include <cstddef>
#include <vector>

#include "gate/calibrated.hpp"
#include "gate_fit/sample.hpp"

namespace flowdlo::lab {

/// What the gate makes of one sample that its scores were not fitted on.
struct Outcome {
  std::vector<std::size_t> returned;  ///< [hypotheses]
  std::vector<double> scores;         ///< [hypotheses]
  std::size_t hypothesis = 0;         ///< that is taken
  double lead = 0;                    ///< gate::lead_elsewhere
};

/// Fills closeness, node_error and sigma_share of `weights`. Twice sigma_m is the length that a
/// node's error stays below with the probability sigma_share, as node_error predicts it.
/// Sigma_share is chosen on the first `counted` scenes, with fits that did not see the scene that
/// they judge. There the share of nodes within sigma_m should be 68 %, and the share within twice
/// sigma_m 95 %. One number seldom meets both: the chosen one is as far above the first as it is
/// below the second, or the other way round, where the distance from 95 % counts 1.25 times.
void calibrate(const std::vector<GateSample>& samples, const std::vector<Outcome>& outcomes,
               std::size_t counted, gate::GateWeights& weights);

}  // namespace flowdlo::lab
