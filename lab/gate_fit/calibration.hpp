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

/// Fills closeness, node_error and sigma_share of `weights`. The last is as large as it has to be
/// for the nodes within one and within two sigma_m, of those of the first `counted` scenes that
/// nothing was fitted on, to be 68 % and 95 %, or to miss them on either side; too narrow counts a
/// quarter more than too wide.
void calibrate(const std::vector<GateSample>& samples, const std::vector<Outcome>& outcomes,
               std::size_t counted, gate::GateWeights& weights);

}  // namespace flowdlo::lab
