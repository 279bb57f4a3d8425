#include "estimator/refinement.hpp"

namespace flowdlo::estimator {

refine::Curve curve_of(const gate::Candidate& candidate) {
  return {candidate.nodes,    candidate.sigma_m, candidate.unseen_m,
          candidate.radius_m, candidate.pixel_m, candidate.noise_m};
}

Result<refine::Refined> refined(const gate::Candidate& prior, const SecondLook& look,
                                const Frame& frame, refine::Network& network, bool ends_known) {
  const bool ends = look.seen && prior.ring == 0 && !ends_known;
  return refine::refined(curve_of(prior), frame, network, ends ? &*look.seen : nullptr);
}

}  // namespace flowdlo::estimator
