// Fit: the weights of the calibrated gate, from samples with truth.
#pragma once

#include <vector>

#include "gate/calibrated.hpp"
#include "gate_fit/sample.hpp"

namespace flowdlo::lab {

/// Mean index error of what is returned of each candidate, Eq. (4.1), in the better direction;
/// where several ropes lie in the mask, the largest that counts.
[[nodiscard]] std::vector<double> errors_m(const GateSample& sample);

/// [64] distances from the truth in the better direction.
[[nodiscard]] std::array<double, kNodes> node_errors_m(const Centerline& nodes,
                                                       const Centerline& truth);

/// Worse errors are all alike to the fit: a single scene must not decide.
inline constexpr double kMostError_m = 0.1;

/// Mean errors over scenes that the scores were not fitted to, cm; each counts kMostError_m at
/// most.
struct Unseen {
  double first_cm = 0;   ///< of the best prior of the first reading,
  double chosen_cm = 0;  ///< of what is chosen,
  double best_cm = 0;    ///< and of the best there was
};

struct GateFit {
  gate::GateWeights weights;
  Unseen unseen;  ///< of `samples`
};

/// `samples` hold at least five. What one stage learns from another's answers, it learns from
/// answers to scenes which that stage was not fitted on. All learn from `also` as well, but the
/// coverage of sigma_m is that of `samples`. With `choice` what those weights choose is kept, which
/// were fitted to other scenes, and confidence and sigma_m alone are fitted to it.
[[nodiscard]] GateFit fit_gate(const std::vector<GateSample>& samples,
                               const std::vector<GateSample>& also = {},
                               const gate::GateWeights* choice = nullptr);

}  // namespace flowdlo::lab
