#include "estimator/returned.hpp"

#include <algorithm>
#include <utility>

#include "estimator/candidates.hpp"
#include "estimator/confidence.hpp"
#include "estimator/hints.hpp"
#include "estimator/stayed.hpp"

namespace flowdlo::estimator {
namespace {

/// The probability that the hypothesis the estimate follows is right. A runner-up's can only come
/// out of what the best one's leaves.
float confidence_of(const std::vector<Hypothesis>& hypotheses,
                    const std::vector<gate::Candidate>& priors, std::size_t used) {
  const float of_best = confidence(priors.front(), lead(hypotheses));
  if (used == 0) return of_best;
  return std::min(1 - of_best, confidence(priors[used], 0));
}

/// Of what is no frame before.
Origin origin_of(const Returned& returned, const std::vector<Hypothesis>& hypotheses) {
  if (returned.draw >= 0) return Origin::kDraw;
  if (hypotheses[returned.hypothesis].reading > 0) return Origin::kOtherReading;
  return returned.hypothesis == 0 ? Origin::kFirstPrior : Origin::kRunnerUp;
}

/// The candidates with the nodes that are held against the frame before.
std::vector<gate::Candidate> as_returned(std::vector<gate::Candidate> candidates,
                                         const Answer& answer) {
  for (gate::Candidate& candidate : candidates) candidate.nodes = answer(candidate);
  return candidates;
}

}  // namespace

Returned by_thesis(const std::vector<Hypothesis>& hypotheses,
                   const std::vector<gate::Candidate>& priors, const flow::Prediction& prediction,
                   const gate::Verdict& verdict, const std::vector<int>& assigned) {
  Returned returned;
  returned.draw = verdict.draw;
  if (verdict.draw >= 0) {
    const int hypothesis = assigned[static_cast<std::size_t>(verdict.draw)];
    returned.hypothesis = static_cast<std::size_t>(hypothesis);
  }
  returned.origin = origin_of(returned, hypotheses);
  returned.confidence = confidence_of(hypotheses, priors, returned.hypothesis);
  returned.sigma_m =
      node_sigma(verdict.source, verdict.draw, prediction, hypotheses[returned.hypothesis].prior);
  return returned;
}

Returned by_score(const std::vector<gate::Candidate>& candidates, const Answer& answer,
                  const gate::Fitted& fitted, const Hints& hints, const Conditions& conditions,
                  const Frame& frame, double rope_length_m, const gate::InAll& in_all,
                  SecondLook& look) {
  gate::Beside beside{.log_prior = hints.previous ? log_priors(as_returned(candidates, answer),
                                                               hints, frame.intrinsics)
                                                  : log_priors(candidates, hints, frame.intrinsics),
                      .in_all = in_all};
  auto before = stayed(hints.previous, look.hypotheses, conditions, frame);
  if (before) {
    beside.guest =
        guest_of(*before, candidates, look, conditions.paths.rope_width_px, frame, rope_length_m);
    beside.guest_log_prior = log_priors({*beside.guest}, hints, frame.intrinsics).front();
  }
  const gate::Choice choice = gate::choose_calibrated(candidates, fitted.of(candidates), beside);
  Returned returned{.confidence = static_cast<float>(choice.probability),
                    .sigma_m = choice.sigma_m,
                    .switched = choice.switched};
  if (choice.chosen == candidates.size()) {
    returned.hypothesis = look.hypotheses.size();
    returned.origin = Origin::kFrameBefore;
    look.hypotheses.push_back(*std::move(before));
  } else {
    returned.draw = candidates[choice.chosen].draw;
    returned.hypothesis = static_cast<std::size_t>(candidates[choice.chosen].hypothesis);
    returned.origin = origin_of(returned, look.hypotheses);
  }
  return returned;
}

}  // namespace flowdlo::estimator
