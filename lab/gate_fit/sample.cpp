#include "gate_fit/sample.hpp"

#include "estimator/candidates.hpp"
#include "estimator/conditions.hpp"
#include "eval/metrics.hpp"
#include "evidence/mask_field.hpp"

namespace flowdlo::lab {

std::optional<GateSample> measure(const synth::SyntheticFrame& scene, flow::Sampler& sampler,
                                  int draws, weights::PriorKind kind) {
  const Frame frame = scene.frame();
  Timings timings;
  const double rope_length_m = 0;
  const auto conditions = estimator::gather(frame, rope_length_m, kind, timings);
  if (!conditions) return std::nullopt;
  const auto assigned =
      estimator::spread_draws(static_cast<int>(conditions->hypotheses.size()), draws);
  std::vector<prior::Prior> draw_priors;
  for (const int hypothesis : assigned) {
    draw_priors.push_back(conditions->hypotheses[static_cast<std::size_t>(hypothesis)].prior);
  }
  const auto field = evidence::mask_field(frame);
  const auto prediction = sampler.sample(
      {.frame = frame, .cloud = conditions->cloud, .field = field, .draw_priors = draw_priors});
  if (!prediction) return std::nullopt;
  GateSample sample;
  sample.index = scene.meta.index;
  sample.scenario = scene.meta.scenario;
  sample.easy = scene.meta.easy();
  sample.hard = scene.meta.hard();
  sample.truth = eval::canonical(scene.truth());
  sample.candidates =
      estimator::list_candidates(*conditions, *prediction, assigned, frame, rope_length_m);
  return sample;
}

}  // namespace flowdlo::lab
