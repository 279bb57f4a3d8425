#include "estimator/candidates.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "geometry/camera.hpp"
#include "geometry/polyline.hpp"

namespace flowdlo::estimator {
namespace {

float mean_distance_m(const Centerline& a, const Centerline& b) {
  float sum = 0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    sum += (geometry::to_eigen(a[i]) - geometry::to_eigen(b[i])).norm();
  }
  return sum / kNodes;
}

/// Mean distance of the draws of one hypothesis to their mean; 0 with a single one.
float spread_m(const flow::Prediction& prediction, const std::vector<int>& assigned,
               int hypothesis) {
  std::vector<const Centerline*> draws;
  for (std::size_t d = 0; d < prediction.draws.size(); ++d) {
    if (assigned[d] == hypothesis && geometry::all_finite(prediction.draws[d])) {
      draws.push_back(&prediction.draws[d]);
    }
  }
  if (draws.size() < 2) return 0;
  const float share = 1 / static_cast<float>(draws.size());
  Centerline mean{};
  for (std::size_t i = 0; i < kNodes; ++i) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (const Centerline* draw : draws) sum += share * geometry::to_eigen((*draw)[i]);
    mean[i] = geometry::to_point(sum);
  }
  float sum = 0;
  for (const Centerline* draw : draws) sum += share * mean_distance_m(*draw, mean);
  return sum;
}

gate::Candidate base(const Hypothesis& hypothesis, int index, double best) {
  gate::Candidate candidate;
  candidate.hypothesis = index;
  candidate.behind = best - hypothesis.score;
  candidate.longest_gap = hypothesis.evidence.longest_gap;
  candidate.bridged = hypothesis.evidence.bridged;
  const auto& support = hypothesis.prior.support;
  candidate.supported =
      static_cast<float>(std::count(support.begin(), support.end(), std::uint8_t{1})) / kNodes;
  return candidate;
}

}  // namespace

std::vector<gate::Candidate> list_candidates(const std::vector<Hypothesis>& hypotheses,
                                             const flow::Prediction& prediction,
                                             const std::vector<int>& assigned, const Frame& frame,
                                             float rope_width_px) {
  gate::TubeView view(frame, rope_width_px);
  const double best = hypotheses.front().score;
  std::vector<gate::Candidate> candidates;
  for (std::size_t h = 0; h < hypotheses.size(); ++h) {
    gate::Candidate candidate = base(hypotheses[h], static_cast<int>(h), best);
    candidate.nodes = hypotheses[h].prior.nodes;
    candidate.radius_m = view.radius_m(candidate.nodes);
    candidate.tube = view.score(candidate.nodes, candidate.radius_m);
    candidates.push_back(candidate);
  }
  for (std::size_t d = 0; d < prediction.draws.size(); ++d) {
    if (!geometry::all_finite(prediction.draws[d])) continue;
    const auto h = static_cast<std::size_t>(assigned[d]);
    gate::Candidate candidate = base(hypotheses[h], assigned[d], best);
    candidate.draw = static_cast<int>(d);
    candidate.nodes = prediction.draws[d];
    candidate.radius_m = candidates[h].radius_m;
    candidate.tube = view.score(candidate.nodes, candidate.radius_m);
    candidate.moved_m = mean_distance_m(candidate.nodes, hypotheses[h].prior.nodes);
    candidate.spread_m = spread_m(prediction, assigned, assigned[d]);
    if (!prediction.sigma_m.empty()) {
      for (const float sigma : prediction.sigma_m[d]) candidate.sigma_m += sigma / kNodes;
    }
    candidates.push_back(candidate);
  }
  return candidates;
}

}  // namespace flowdlo::estimator
