// Hints: what a caller knows beside the frame, as evidence for the gate and as an order of the
// ends.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "flowdlo/estimate.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/hints.hpp"
#include "flowdlo/result.hpp"
#include "gate/candidate.hpp"

namespace flowdlo::estimator {

/// Expects a valid frame. Fails with kBadInput, naming every fault.
[[nodiscard]] Result<void> check(const Hints& hints, const Frame& frame);

/// Hints::ends as path::TraceConfig has them.
[[nodiscard]] std::vector<Eigen::Vector2f> end_directions(const Hints& hints,
                                                          const Intrinsics& camera);

/// [candidates] the log of how likely each is beside the others by the frame before, by the ends
/// that are given and by whether it closes, 0 at most; empty where nothing is given. The former two
/// are mixtures: with a fixed share each says nothing of this frame, so that a frame that is clear
/// overrules it.
[[nodiscard]] std::vector<double> log_priors(const std::vector<gate::Candidate>& candidates,
                                             const Hints& hints, const Intrinsics& camera);

/// Gives nodes, support, sigma_m and alternatives the order that the hints ask for.
void turn(Estimate& estimate, const Hints& hints, const Intrinsics& camera);

}  // namespace flowdlo::estimator
