#include "estimator/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "gate/image_curve.hpp"
#include "geometry/polyline.hpp"

namespace flowdlo::estimator {
namespace {

float length_off(const Centerline& nodes, double rope_length_m) {
  if (!(rope_length_m > 0)) return 0;
  const auto segments = geometry::segment_lengths(nodes);
  const double length_m = std::accumulate(segments.begin(), segments.end(), 0.0);
  return static_cast<float>(std::abs(std::log(std::max(1e-6, length_m) / rope_length_m)));
}

/// [64] metres along the rope to the nearest node with support; its length where there is none.
std::array<float, kNodes> unseen_m(const Centerline& nodes,
                                   const std::array<std::uint8_t, kNodes>& support) {
  const auto segments_m = geometry::segment_lengths(nodes);
  const auto step_m = [&](std::size_t i) { return static_cast<float>(segments_m[i]); };
  std::array<float, kNodes> unseen_m{};
  unseen_m.fill(static_cast<float>(std::accumulate(segments_m.begin(), segments_m.end(), 0.0)));
  for (std::size_t i = 0; i < kNodes; ++i) {
    if (i > 0) unseen_m[i] = std::min(unseen_m[i], unseen_m[i - 1] + step_m(i - 1));
    if (support[i] != 0) unseen_m[i] = 0;
  }
  for (std::size_t i = kNodes - 1; i-- > 0;) {
    unseen_m[i] = std::min(unseen_m[i], unseen_m[i + 1] + step_m(i));
  }
  return unseen_m;
}

gate::Candidate prior_candidate(const Hypothesis& hypothesis, int index, double best) {
  gate::Candidate candidate;
  candidate.nodes = hypothesis.prior.nodes;
  candidate.sigma_m = hypothesis.prior.sigma_m;
  candidate.hypothesis = index;
  candidate.behind = best - hypothesis.score;
  candidate.reread = hypothesis.reading > 0;
  candidate.votes = hypothesis.votes;
  candidate.odds = hypothesis.odds;
  candidate.seen_odds = hypothesis.seen_odds;
  const auto& support = hypothesis.prior.support;
  candidate.supported =
      static_cast<float>(std::count(support.begin(), support.end(), std::uint8_t{1})) / kNodes;
  const Course& course = hypothesis.course;
  candidate.bridged = course.bridged;
  candidate.longest_gap = course.longest_gap;
  candidate.hidden_ends = course.hidden_ends;
  candidate.buried_ends = course.buried_ends;
  candidate.ring = course.ring ? 1 : 0;
  return candidate;
}

/// What a candidate of that hypothesis looks like beside the frame.
void measure(const Hypothesis& hypothesis, const SecondLook& look, const Frame& frame,
             double rope_length_m, gate::TubeView& view, gate::Candidate& candidate) {
  candidate.tube = view.score(candidate.nodes, candidate.radius_m);
  candidate.pixel_m = gate::pixel_m(candidate.nodes, frame.intrinsics);
  candidate.noise_m = view.noise_m();
  candidate.unseen_m = unseen_m(candidate.nodes, hypothesis.prior.support);
  candidate.length_off = length_off(candidate.nodes, rope_length_m);
  if (look.axes) {
    candidate.axes = gate::score_axes(
        *look.axes, gate::image_curve(candidate.nodes, frame, look.axes->width_px));
  }
}

}  // namespace

std::vector<gate::Candidate> list_candidates(const SecondLook& look, float rope_width_px,
                                             const flow::Prediction& prediction,
                                             const std::vector<DrawReport>& reports,
                                             const std::vector<int>& assigned, const Frame& frame,
                                             double rope_length_m) {
  const auto& hypotheses = look.hypotheses;
  gate::TubeView view(frame, rope_width_px);
  std::vector<gate::Candidate> candidates;
  const auto add = [&](gate::Candidate& candidate) {
    const auto h = static_cast<std::size_t>(candidate.hypothesis);
    measure(hypotheses[h], look, frame, rope_length_m, view, candidate);
    candidates.push_back(candidate);
  };
  for (std::size_t h = 0; h < hypotheses.size(); ++h) {
    auto candidate = prior_candidate(hypotheses[h], static_cast<int>(h), hypotheses.front().score);
    candidate.radius_m = view.radius_m(candidate.nodes);
    candidate.readings = look.readings;
    add(candidate);
  }
  for (std::size_t d = 0; d < prediction.draws.size(); ++d) {
    if (!reports[d].accepted) continue;
    gate::Candidate candidate = candidates[static_cast<std::size_t>(assigned[d])];
    candidate.draw = static_cast<int>(d);
    candidate.nodes = prediction.draws[d];
    if (!prediction.sigma_m.empty()) candidate.sigma_m = prediction.sigma_m[d];
    add(candidate);
  }
  return candidates;
}

gate::Candidate guest_of(const Hypothesis& hypothesis,
                         const std::vector<gate::Candidate>& candidates, const SecondLook& look,
                         float rope_width_px, const Frame& frame, double rope_length_m) {
  gate::TubeView view(frame, rope_width_px);
  auto candidate = prior_candidate(hypothesis, static_cast<int>(candidates.size()),
                                   look.hypotheses.front().score);
  candidate.radius_m = view.radius_m(candidate.nodes);
  candidate.readings = look.readings;
  measure(hypothesis, look, frame, rope_length_m, view, candidate);
  return candidate;
}

}  // namespace flowdlo::estimator
