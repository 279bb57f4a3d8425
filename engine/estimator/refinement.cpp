#include "estimator/refinement.hpp"

#include "refine/refined.hpp"

namespace flowdlo::estimator {

refine::Curve curve_of(const gate::Candidate& candidate) {
  return {candidate.nodes,    candidate.sigma_m, candidate.unseen_m,
          candidate.radius_m, candidate.pixel_m, candidate.noise_m};
}

Result<std::optional<Centerline>> refined(const Returned& returned,
                                          const std::vector<gate::Candidate>& candidates,
                                          const Frame& frame, refine::Network* network) {
  const bool prior = returned.draw < 0 && returned.origin != Origin::kFrameBefore;
  if (network == nullptr || !prior || returned.hypothesis >= candidates.size()) {
    return std::optional<Centerline>();
  }
  auto nodes = refine::refined(curve_of(candidates[returned.hypothesis]), frame, *network);
  if (!nodes) return nodes.error();
  return std::optional(*nodes);
}

}  // namespace flowdlo::estimator
