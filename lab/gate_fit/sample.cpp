#include "gate_fit/sample.hpp"

#include "estimator/candidates.hpp"
#include "estimator/conditions.hpp"
#include "eval/metrics.hpp"
#include "evidence/mask_field.hpp"
#include "gate/gate.hpp"

namespace flowdlo::lab {

std::optional<GateSample> measure(const synth::SyntheticFrame& scene, flow::Sampler& sampler,
                                  int draws, weights::PriorKind kind, double rope_length_m) {
  const Frame frame = scene.frame();
  Timings timings;
  const auto conditions = estimator::gather(frame, rope_length_m, kind, timings);
  if (!conditions) return std::nullopt;
  const auto assigned =
      estimator::spread_draws(static_cast<int>(conditions->hypotheses.size()), draws);
  std::vector<prior::Prior> draw_priors;
  std::vector<Centerline> draw_prior_nodes;
  for (const int hypothesis : assigned) {
    draw_priors.push_back(conditions->hypotheses[static_cast<std::size_t>(hypothesis)].prior);
    draw_prior_nodes.push_back(draw_priors.back().nodes);
  }
  const auto field = evidence::mask_field(frame);
  const auto prediction = sampler.sample(
      {.frame = frame, .cloud = conditions->cloud, .field = field, .draw_priors = draw_priors});
  if (!prediction) return std::nullopt;
  const auto verdict =
      gate::choose(prediction->draws, draw_prior_nodes, conditions->hypotheses.front().prior.nodes,
                   gate::DilatedMask(frame), frame.intrinsics);
  GateSample sample;
  sample.index = scene.meta.index;
  sample.scenario = scene.meta.scenario;
  sample.easy = scene.meta.easy();
  sample.hard = scene.meta.hard();
  sample.truth = eval::canonical(scene.truth());
  sample.candidates = estimator::list_candidates(*conditions, *prediction, verdict.draws, assigned,
                                                 frame, rope_length_m);
  return sample;
}

}  // namespace flowdlo::lab
