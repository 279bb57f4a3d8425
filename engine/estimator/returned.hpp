// Returned: what the estimate will be, as either gate has it.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "estimator/conditions.hpp"
#include "estimator/second_look.hpp"
#include "flow/sampler.hpp"
#include "flowdlo/estimate.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/hints.hpp"
#include "gate/calibrated.hpp"
#include "gate/candidate.hpp"
#include "gate/fitted.hpp"
#include "gate/gate.hpp"

namespace flowdlo::estimator {

struct Returned {
  int draw = -1;  ///< -1: the prior of the hypothesis
  std::size_t hypothesis = 0;
  Origin origin = Origin::kFirstPrior;
  float confidence = 0;
  std::array<float, kNodes> sigma_m{};
  bool switched = false;  ///< by a hint it is another hypothesis than without one
};

/// Eq. (3.33). `priors`: `list_candidates` without draws; `assigned` is [D], the hypothesis that
/// each draw was conditioned on.
[[nodiscard]] Returned by_thesis(const std::vector<Hypothesis>& hypotheses,
                                 const std::vector<gate::Candidate>& priors,
                                 const flow::Prediction& prediction, const gate::Verdict& verdict,
                                 const std::vector<int>& assigned);

/// The nodes that would be returned of a candidate, as the frame before has returned its own.
using Answer = std::function<Centerline(const gate::Candidate&)>;

/// What the fitted score and the hints prefer among the candidates, `list_candidates`. Where that
/// is the rope as it was in the frame before, it joins the hypotheses of `look`.
[[nodiscard]] Returned by_score(const std::vector<gate::Candidate>& candidates,
                                const Answer& answer, const gate::Fitted& fitted,
                                const Hints& hints, const Conditions& conditions,
                                const Frame& frame, double rope_length_m, const gate::InAll& in_all,
                                SecondLook& look);

}  // namespace flowdlo::estimator
