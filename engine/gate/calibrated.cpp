#include "gate/calibrated.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/polyline.hpp"

namespace flowdlo::gate {
namespace {

constexpr double kUnopposed = 99;

}  // namespace

std::vector<std::size_t> returned_by(std::span<const Candidate> candidates,
                                     const GateWeights& weights) {
  std::vector<std::size_t> returned;
  std::vector<double> best;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (candidates[i].draw < 0) {
      returned.push_back(i);
      best.push_back(weights.draw_margin);
      continue;
    }
    const double score = dot(draw_features(candidates, i), weights.draw);
    const auto hypothesis = static_cast<std::size_t>(candidates[i].hypothesis);
    if (!(score > best[hypothesis])) continue;
    best[hypothesis] = score;
    returned[hypothesis] = i;
  }
  return returned;
}

double hypothesis_score(std::span<const Candidate> candidates, std::size_t index,
                        const GateWeights& weights) {
  const double score = weights.hypothesis(hypothesis_features(candidates, index)).front();
  return std::isfinite(score) ? score : std::numeric_limits<double>::lowest();
}

std::size_t preferred(std::span<const double> scores, double margin) {
  const auto best =
      static_cast<std::size_t>(std::max_element(scores.begin(), scores.end()) - scores.begin());
  return scores[best] > scores[0] + margin ? best : 0;
}

double lead_elsewhere(std::span<const Candidate> candidates, std::span<const std::size_t> returned,
                      std::span<const double> scores, std::size_t chosen) {
  double lead = kUnopposed;
  for (std::size_t h = 0; h < returned.size(); ++h) {
    if (h == chosen || !runs_elsewhere(candidates[returned[chosen]], candidates[returned[h]])) {
      continue;
    }
    lead = std::min(lead, scores[chosen] - scores[h]);
  }
  return lead;
}

Choice choose_calibrated(std::span<const Candidate> frames_own, const GateWeights& weights,
                         const Beside& beside) {
  auto returned = returned_by(frames_own, weights);
  std::vector<double> scores;
  for (const std::size_t index : returned) {
    scores.push_back(hypothesis_score(frames_own, index, weights));
  }
  const std::size_t by_frame = preferred(scores, weights.hypothesis_margin);
  std::vector<double> with_prior = scores;
  for (std::size_t h = 0; h < scores.size() && !beside.log_prior.empty(); ++h) {
    with_prior[h] += beside.log_prior[returned[h]];
  }
  std::vector<Candidate> candidates(frames_own.begin(), frames_own.end());
  double guest_score = 0;
  if (beside.guest) {
    candidates.push_back(*beside.guest);
    guest_score = hypothesis_score(candidates, frames_own.size(), weights);
    with_prior.push_back(guest_score + beside.guest_log_prior);
  }
  const std::size_t hypothesis = preferred(with_prior, weights.hypothesis_margin);
  if (hypothesis == returned.size()) {
    returned.push_back(frames_own.size());
    scores.push_back(guest_score);
  } else {
    candidates.resize(frames_own.size());
  }
  const double lead = lead_elsewhere(candidates, returned, scores, hypothesis);
  Choice choice;
  choice.chosen = returned[hypothesis];
  const Centerline& alone = candidates[returned[by_frame]].nodes;
  choice.switched = geometry::mean_distance(candidates[choice.chosen].nodes, alone) >
                    2 * static_cast<double>(candidates.front().radius_m);  // the rope's diameter
  const double logit =
      weights.closeness(closeness_features(candidates, choice.chosen, lead)).front();
  choice.probability = std::isfinite(logit) ? 1 / (1 + std::exp(-logit)) : 0;
  if (beside.in_all) {
    for (Candidate& candidate : candidates) candidate.ring = 0;
  }
  const double in_all = beside.in_all ? beside.in_all(choice.probability) : choice.probability;
  const NodeFeatures features(candidates, returned, scores, hypothesis, in_all);
  for (std::size_t node = 0; node < kNodes; ++node) {
    const NodeError error(weights.node_error(features.of(node)));
    choice.sigma_m[node] = static_cast<float>(0.5 * error.quantile_m(weights.sigma_share));
  }
  return choice;
}

}  // namespace flowdlo::gate
