// Candidates: every centerline that one frame has brought forth, for the calibrated gate.
#pragma once

#include <vector>

#include "estimator/second_look.hpp"
#include "flow/sampler.hpp"
#include "flowdlo/frame.hpp"
#include "gate/candidate.hpp"

namespace flowdlo::estimator {

/// First the prior of each hypothesis, then each draw that is plausible, Eq. (3.31) and (3.32), by
/// its report. `assigned` is [D], the hypothesis that each draw was conditioned on; `rope_length_m`
/// 0: unknown.
[[nodiscard]] std::vector<gate::Candidate> list_candidates(
    const SecondLook& look, float rope_width_px, const flow::Prediction& prediction,
    const std::vector<DrawReport>& reports, const std::vector<int>& assigned, const Frame& frame,
    double rope_length_m);

/// A hypothesis that no reading of this frame brought forth, as the one after `candidates`.
[[nodiscard]] gate::Candidate guest_of(const Hypothesis& hypothesis,
                                       const std::vector<gate::Candidate>& candidates,
                                       const SecondLook& look, float rope_width_px,
                                       const Frame& frame, double rope_length_m);

}  // namespace flowdlo::estimator
