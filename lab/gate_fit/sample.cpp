#include "gate_fit/sample.hpp"

#include "estimator/candidates.hpp"
#include "estimator/conditions.hpp"
#include "estimator/judge.hpp"
#include "estimator/refinement.hpp"
#include "estimator/second_look.hpp"
#include "eval/metrics.hpp"
#include "evidence/mask_field.hpp"
#include "gate/gate.hpp"
#include "gate/one_rope.hpp"
#include "geometry/ring.hpp"
#include "refine/refined.hpp"

namespace flowdlo::lab {
namespace {

/// What the model makes of a frame; without one, nothing.
struct Drawn {
  std::vector<int> assigned;
  flow::Prediction prediction;
  std::vector<DrawReport> reports;
};

std::optional<Drawn> draw(const Frame& frame, const estimator::Conditions& conditions,
                          flow::Sampler* sampler, int draws) {
  Drawn drawn;
  if (sampler == nullptr) return drawn;
  const auto& hypotheses = conditions.hypotheses;
  drawn.assigned = estimator::spread_draws(static_cast<int>(hypotheses.size()), draws);
  std::vector<prior::Prior> priors;
  std::vector<Centerline> prior_nodes;
  for (const int hypothesis : drawn.assigned) {
    priors.push_back(hypotheses[static_cast<std::size_t>(hypothesis)].prior);
    prior_nodes.push_back(priors.back().nodes);
  }
  const auto mask_field = evidence::mask_field(frame);
  auto prediction = sampler->sample(
      {.frame = frame, .cloud = conditions.cloud, .field = mask_field, .draw_priors = priors});
  if (!prediction) return std::nullopt;
  drawn.prediction = *std::move(prediction);
  drawn.reports = gate::choose(drawn.prediction.draws, prior_nodes, prior_nodes.front(),
                               gate::DilatedMask(frame), frame.intrinsics)
                      .draws;
  return drawn;
}

}  // namespace

std::optional<GateSample> measure(const synth::SyntheticFrame& scene, flow::Sampler* sampler,
                                  field::Network* field, refine::Network* refine,
                                  const gate::Fitted* fitted, int draws, weights::PriorKind kind,
                                  const Hints& known) {
  Frame frame = scene.frame();
  Timings timings;
  const double rope_length_m = known.rope_length_m.value_or(0);
  const estimator::ReadConfig reading{
      .prior_kind = kind, .rope_length_m = rope_length_m, .closed = known.closed};
  auto conditions = estimator::gather(frame, reading, timings, nullptr, estimator::seen_by(field));
  if (!conditions) return std::nullopt;
  frame = estimator::read_frame(frame, *conditions);
  const Hints none;
  const estimator::Judge judge(fitted, none, *conditions, frame, rope_length_m, refine);
  const auto first = judge.of_first(false);
  if (!first) return std::nullopt;
  const auto drawn = draw(frame, *conditions, sampler, draws);
  if (!drawn) return std::nullopt;
  GateSample sample;
  sample.index = scene.meta.index;
  sample.scenario = scene.meta.scenario;
  sample.easy = scene.meta.easy();
  sample.hard = scene.meta.hard();
  sample.several = scene.ropes.size() > 1;
  sample.truth = eval::canonical(scene.truth());
  threads::Pool alone(1);
  const auto look =
      *first ? (*first)->look
             : estimator::Rereading(alone, true, field, *conditions, frame, reading).finish();
  sample.candidates =
      estimator::list_candidates(look, conditions->paths.rope_width_px, drawn->prediction,
                                 drawn->reports, drawn->assigned, frame, rope_length_m);
  for (const gate::Candidate& candidate : sample.candidates) {
    if (refine == nullptr) break;
    auto refined = candidate.draw >= 0
                       ? Result<refine::Refined>(refine::Refined{candidate.nodes})
                       : estimator::refined(candidate, look, frame, *refine, rope_length_m);
    if (!refined) return std::nullopt;
    sample.refined.push_back(refined->nodes);
  }
  if (scene.ropes.front().closed && !sample.several) {
    sample.truth = eval::canonical(geometry::told_like(scene.truth(), sample.answer(0)).nodes);
  }
  for (std::size_t i = 0; i < sample.candidates.size(); ++i) {
    const auto one = gate::one_rope(sample.answer(i), frame, conditions->paths.rope_width_px);
    sample.doubted.push_back(one.doubts.empty() ? 0 : 1);
  }
  return sample;
}

}  // namespace flowdlo::lab
