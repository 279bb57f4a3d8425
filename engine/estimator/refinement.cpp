#include "estimator/refinement.hpp"

namespace flowdlo::estimator {

namespace {

refine::EndsKnown ends_known(const gate::Candidate& prior, const SecondLook& look,
                             double rope_length_m, const Hints& hints) {
  const bool moved = look.seen && prior.ring == 0 && hints.ends.empty();
  return {moved ? &*look.seen : nullptr, rope_length_m};
}

}  // namespace

refine::Curve curve_of(const gate::Candidate& candidate) {
  return {candidate.nodes,    candidate.sigma_m, candidate.unseen_m,
          candidate.radius_m, candidate.pixel_m, candidate.noise_m};
}

Result<refine::Refined> refined(const gate::Candidate& prior, const SecondLook& look,
                                const Frame& frame, refine::Network& network, double rope_length_m,
                                const Hints& hints) {
  return refine::refined(curve_of(prior), frame, network,
                         ends_known(prior, look, rope_length_m, hints));
}

Centerline with_tips(const gate::Candidate& prior, const SecondLook& look, const Frame& frame,
                     const refine::Network& network, double rope_length_m, const Hints& hints) {
  return refine::with_tips(curve_of(prior), prior.nodes, frame, network,
                           ends_known(prior, look, rope_length_m, hints))
      .nodes;
}

}  // namespace flowdlo::estimator
