// Refinement: the chosen hypothesis with its nodes where the refining network sees the rope's axis.
#pragma once

#include <optional>
#include <vector>

#include "estimator/returned.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "gate/candidate.hpp"
#include "refine/network.hpp"
#include "refine/strip.hpp"

namespace flowdlo::estimator {

/// A candidate as the refining network is told about it.
[[nodiscard]] refine::Curve curve_of(const gate::Candidate& candidate);

/// As refine::refined() of what is returned. Nothing without a network, and where that is no prior
/// of this frame: the network has seen no other. `candidates` as list_candidates() has them.
[[nodiscard]] Result<std::optional<Centerline>> refined(
    const Returned& returned, const std::vector<gate::Candidate>& candidates, const Frame& frame,
    refine::Network* network);

}  // namespace flowdlo::estimator
