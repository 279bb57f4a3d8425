#include "estimator/judge.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "estimator/candidates.hpp"
#include "estimator/refinement.hpp"
#include "gate/one_rope.hpp"
#include "geometry/camera.hpp"
#include "geometry/polyline.hpp"

namespace flowdlo::estimator {

struct Judge::Chosen {
  SecondLook look;
  std::vector<gate::Candidate> candidates{};  // none as the thesis has it
  Returned returned{};
};

namespace {

/// Of how far a node lies beyond what was read. Of 670 ends of `wide` training scenes whose rope
/// goes on for three widths and more, straight on for as long is off by 0.36 of the way (68 %) and
/// 1.17 (95 %).
constexpr float kGuessed = 0.5F;

/// What lies beyond the ends of the hypothesis by more than a radius is a guess: nothing supports
/// it, and it is the farther off the longer the way.
void own_to_guesses(const std::array<float, 2>& beyond_m, float radius_m, Judged& judged) {
  const float step_m = geometry::length(judged.nodes) / (kNodes - 1);
  for (std::size_t i = 0; i < kNodes; ++i) {
    const auto along_m = step_m * static_cast<float>(i);
    const float from_last_m = step_m * static_cast<float>(kNodes - 1 - i);
    const float guessed_m = std::max(beyond_m[0] - along_m, beyond_m[1] - from_last_m);
    if (guessed_m <= radius_m) continue;
    judged.support[i] = 0;
    float& sigma_m = judged.returned.sigma_m[i];
    sigma_m = std::max(sigma_m, kGuessed * guessed_m);
  }
}

/// A ring's first node and its last are one place, which networks move each by itself.
void close_ring(Centerline& nodes) {
  const Eigen::Vector3f middle =
      0.5F * (geometry::to_eigen(nodes.front()) + geometry::to_eigen(nodes.back()));
  nodes.front() = nodes.back() = geometry::to_point(middle);
}

}  // namespace

Judge::Chosen Judge::choose(SecondLook look, const Sampled& sampled) const {
  Chosen chosen{.look = std::move(look)};
  if (fitted_ == nullptr) {
    const auto priors = list_candidates(chosen.look, conditions_.paths.rope_width_px, {}, {}, {},
                                        frame_, rope_length_m_);
    chosen.returned = by_thesis(chosen.look.hypotheses, priors, sampled.prediction, sampled.verdict,
                                sampled.assigned);
    return chosen;
  }
  chosen.candidates =
      list_candidates(chosen.look, conditions_.paths.rope_width_px, sampled.prediction,
                      sampled.verdict.draws, sampled.assigned, frame_, rope_length_m_);
  const auto answer = [&](const gate::Candidate& candidate) {
    if (refine_ == nullptr || candidate.draw >= 0) return candidate.nodes;
    return with_tips(candidate, chosen.look, frame_, *refine_, rope_length_m_, hints_);
  };
  chosen.returned = by_score(chosen.candidates, answer, *fitted_, hints_, conditions_, frame_,
                             rope_length_m_, in_all_, chosen.look);
  return chosen;
}

Result<Judged> Judge::settle(Chosen chosen, const Sampled& sampled) const {
  Judged judged;
  judged.look = std::move(chosen.look);
  judged.returned = std::move(chosen.returned);
  const Returned& returned = judged.returned;
  judged.nodes = returned.draw >= 0
                     ? sampled.prediction.draws[static_cast<std::size_t>(returned.draw)]
                     : judged.look.hypotheses[returned.hypothesis].prior.nodes;
  judged.support = judged.look.hypotheses[returned.hypothesis].prior.support;
  const bool prior = returned.draw < 0 && returned.origin != Origin::kFrameBefore;
  if (refine_ != nullptr && prior && returned.hypothesis < chosen.candidates.size()) {
    const auto moved = refined(chosen.candidates[returned.hypothesis], judged.look, frame_,
                               *refine_, rope_length_m_, hints_);
    if (!moved) return moved.error();
    judged.nodes = moved->nodes;
    own_to_guesses(moved->beyond_m, chosen.candidates[returned.hypothesis].radius_m, judged);
  }
  if (judged.look.hypotheses[returned.hypothesis].course.closed) close_ring(judged.nodes);
  judged.one_rope = gate::one_rope(judged.nodes, frame_, conditions_.paths.rope_width_px);
  judged.confidence = gate::doubted(returned.confidence, judged.one_rope);
  return judged;
}

Result<std::optional<Judged>> Judge::of_first(bool traced) const {
  if (fitted_ == nullptr || !(traced || conditions_.axes)) return std::optional<Judged>();
  Chosen chosen = choose(first_look(conditions_, frame_), {});
  const bool ring = chosen.look.hypotheses[chosen.returned.hypothesis].course.closed;
  const auto doubtful = [&](float confidence) { return !traced && (ring || confidence < kSure); };
  if (doubtful(chosen.returned.confidence)) return std::optional<Judged>();
  auto judged = settle(std::move(chosen), {});
  if (!judged) return judged.error();
  if (doubtful(judged->confidence)) return std::optional<Judged>();
  return std::optional(*std::move(judged));
}

Result<Judged> Judge::of_all(SecondLook look, const Sampled& sampled) const {
  return settle(choose(std::move(look), sampled), sampled);
}

Estimate conclude(Judged judged, std::vector<DrawReport> draws, const gate::DilatedMask& mask,
                  const Frame& frame) {
  const Returned& returned = judged.returned;
  const auto& hypotheses = judged.look.hypotheses;
  Estimate estimate;
  estimate.source = returned.draw >= 0 ? Source::kPrediction : Source::kPrior;
  estimate.origin = returned.origin;
  estimate.draw = returned.draw;
  estimate.nodes = judged.nodes;
  estimate.support = judged.support;
  estimate.closed = hypotheses[returned.hypothesis].course.closed;
  estimate.sigma_m = returned.sigma_m;
  estimate.mask_agreement = mask.agreement(estimate.nodes, frame.intrinsics);
  estimate.prior_mask_agreement = mask.agreement(hypotheses.front().prior.nodes, frame.intrinsics);
  estimate.one_rope = std::move(judged.one_rope);
  estimate.confidence = judged.confidence;
  estimate.switched = returned.switched;
  estimate.readings = judged.look.readings;
  estimate.draws = std::move(draws);
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    if (i == returned.hypothesis) continue;
    const auto& other = hypotheses[i];
    estimate.alternatives.push_back({other.prior.nodes, static_cast<float>(other.score),
                                     mask.agreement(other.prior.nodes, frame.intrinsics)});
  }
  std::stable_sort(estimate.alternatives.begin(), estimate.alternatives.end(),
                   [](const Alternative& a, const Alternative& b) { return a.score > b.score; });
  return estimate;
}

void doubt_depth(Estimate& estimate) {
  estimate.support.fill(0);
  estimate.one_rope.doubts.push_back(Doubt::kNoDepth);
  estimate.confidence = gate::doubted(estimate.confidence, estimate.one_rope);
}

}  // namespace flowdlo::estimator
