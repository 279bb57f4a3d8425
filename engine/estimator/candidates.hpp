// Candidates: every centerline that one frame has brought forth, for the calibrated gate.
#pragma once

#include <vector>

#include "estimator/hypotheses.hpp"
#include "flow/sampler.hpp"
#include "flowdlo/frame.hpp"
#include "gate/candidate.hpp"

namespace flowdlo::estimator {

/// First the prior of each hypothesis, then each finite draw; `assigned` is [D], the hypothesis
/// that each draw was conditioned on. `rope_width_px` is path::Traversals'.
[[nodiscard]] std::vector<gate::Candidate> list_candidates(
    const std::vector<Hypothesis>& hypotheses, const flow::Prediction& prediction,
    const std::vector<int>& assigned, const Frame& frame, float rope_width_px);

}  // namespace flowdlo::estimator
