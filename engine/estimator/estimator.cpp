// Estimator: the one file that sees every room. Chapter 3 of the thesis, Figure 3.1.
#include "flowdlo/estimator.hpp"

#include <unistd.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "estimator/budget.hpp"
#include "estimator/candidates.hpp"
#include "estimator/conditions.hpp"
#include "estimator/config_check.hpp"
#include "estimator/device_choice.hpp"
#include "estimator/device_sampler.hpp"
#include "estimator/hints.hpp"
#include "estimator/known_scene.hpp"
#include "estimator/opening.hpp"
#include "estimator/refinement.hpp"
#include "estimator/returned.hpp"
#include "estimator/second_look.hpp"
#include "estimator/several.hpp"
#include "estimator/stopwatch.hpp"
#include "estimator/tensors.hpp"
#include "evidence/mask_field.hpp"
#include "field/strand_field.hpp"
#include "flow/sampler.hpp"
#include "gate/gate.hpp"
#include "gate/one_rope.hpp"
#include "guard/guarded.hpp"
#include "prior/prior.hpp"
#include "threads/aside.hpp"
#include "threads/count.hpp"
#include "threads/pool.hpp"
#include "weights/kept_file.hpp"
#include "weights/location.hpp"
#include "weights/weights.hpp"

namespace flowdlo {
namespace {

/// The caller's view of what the gate chose.
Estimate conclude(const estimator::Returned& returned, const std::optional<Centerline>& refined,
                  const std::vector<estimator::Hypothesis>& hypotheses,
                  const flow::Prediction& prediction, gate::Verdict verdict,
                  const gate::DilatedMask& mask, const Frame& frame) {
  const prior::Prior& prior = hypotheses[returned.hypothesis].prior;
  Estimate estimate;
  estimate.source = returned.draw >= 0 ? Source::kPrediction : Source::kPrior;
  estimate.origin = returned.origin;
  estimate.draw = returned.draw;
  estimate.nodes =
      returned.draw >= 0 ? prediction.draws[static_cast<std::size_t>(returned.draw)] : prior.nodes;
  if (refined) estimate.nodes = *refined;
  estimate.support = prior.support;
  estimate.closed = hypotheses[returned.hypothesis].evidence.closed;
  estimate.sigma_m = returned.sigma_m;
  estimate.mask_agreement = mask.agreement(estimate.nodes, frame.intrinsics);
  estimate.prior_mask_agreement = verdict.prior_agreement;
  estimate.confidence = returned.confidence;
  estimate.switched = returned.switched;
  estimate.draws = std::move(verdict.draws);
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

}  // namespace

/// A member class is as visible as its owner unless it says otherwise.
struct FLOWDLO_HIDDEN Estimator::Impl {
  Config config;
  weights::Metadata metadata;
  estimator::DeviceSampler sampler;
  estimator::FieldNetworks networks;
  threads::Pool pool{config.threads};  // for what runs beside the model
  estimator::ReadingCosts reading_costs{};
  estimator::Cost model_cost{0};  // mask field and all
  estimator::Cost gate_cost{0};
  pid_t process = ::getpid();  // in a process forked from this one threads and device are missing

  estimator::Fetch fetch{};  // of the host's device

  /// `host`: null for a device of our own.
  static Result<std::unique_ptr<Impl>> create(const Config& config, const VulkanHost* host);
  void learn_costs();
  Result<Estimate> estimate(const Frame& frame, const Hints& hints, Tensors* tensors,
                            const estimator::Budget& budget,
                            const path::Traversals* traced = nullptr);
  [[nodiscard]] weights::PriorKind prior_kind() const;
  [[nodiscard]] bool calibrated() const;
  [[nodiscard]] estimator::ReadingLimits limits(const estimator::Budget& budget,
                                                const Timings& timings);
  [[nodiscard]] double sampling_ms(const estimator::Rereading& rereading) const;
  [[nodiscard]] std::optional<field::Axes> axes(const Frame& frame, float rope_width_px,
                                                const estimator::Budget& budget);
  [[nodiscard]] std::vector<int> assign(const std::vector<estimator::Hypothesis>& hypotheses) const;
};

Result<std::unique_ptr<Estimator::Impl>> Estimator::Impl::create(const Config& wanted,
                                                                 const VulkanHost* host) {
  if (auto checked = estimator::check(wanted); !checked) return checked.error();
  const auto location = wanted.weights.empty()
                            ? weights::default_location()
                            : Result<weights::Location>(weights::located(wanted.weights));
  if (!location) return location.error();
  // Opening a driver takes as long as reading the weights: side by side, where a thread is to be
  // had.
  const bool beside = threads::count(wanted.threads) > 1;
  auto choice = threads::aside(beside, [&] {
    return host != nullptr ? estimator::host_back_end(wanted, *host)
                           : estimator::choose_back_end(wanted);
  });
  auto loaded = weights::load_and_keep(location->model);
  auto back_end = choice.get();
  if (!loaded) return loaded.error();
  const weights::Metadata metadata = loaded->weights->metadata;
  const Config config = estimator::resolved(wanted, metadata);
  if (!back_end) return back_end.error();
  estimator::Fetch fetch = back_end->fetch;
  auto sampler =
      estimator::DeviceSampler::create(config, estimator::source_of(*loaded), *std::move(back_end));
  if (!sampler) return sampler.error();
  auto networks = estimator::open_field(config, location->field);
  if (!networks) return networks.error();
  auto impl = std::unique_ptr<Impl>(  // an aggregate, which Clang 14 makes by braces only
      new Impl{config, metadata, *std::move(sampler), *std::move(networks)});
  impl->fetch = std::move(fetch);
  if (config.budget_ms > 0) impl->learn_costs();
  return impl;
}

/// What the model and the gate take is known before the first frame comes.
void Estimator::Impl::learn_costs() {
  const estimator::KnownScene scene;
  Tensors tensors;  // nothing is left out where they are asked for
  (void)estimate(scene.frame(), {}, &tensors, estimator::Budget(config.budget_ms));
}

weights::PriorKind Estimator::Impl::prior_kind() const {
  switch (config.prior) {
    case PriorChoice::kThesis:
      return weights::PriorKind::kThesis;
    case PriorChoice::kRefined:
      return weights::PriorKind::kRefined;
    case PriorChoice::kOfWeights:
      break;
  }
  return metadata.variant.prior_kind;
}

/// Whether the fitted score decides. It was fitted to the model that comes with FlowDLO.
bool Estimator::Impl::calibrated() const {
  switch (config.gate) {
    case GateChoice::kThesis:
      return false;
    case GateChoice::kCalibrated:
      return true;
    case GateChoice::kOfWeights:
      break;
  }
  return metadata.trained && metadata.variant.head_channels == 4 &&
         metadata.variant.prior_kind == weights::PriorKind::kRefined;
}

/// Of a frame whose first reading took as long as `timings` say.
estimator::ReadingLimits Estimator::Impl::limits(const estimator::Budget& budget,
                                                 const Timings& timings) {
  if (!budget.bounded()) return {};
  return {&budget, &reading_costs, timings.path_ms + timings.prior_ms, gate_cost.of(1)};
}

/// What the model, and all that has to follow, will take. Readings come first where they have no
/// thread of their own: they change more estimates than the model does.
double Estimator::Impl::sampling_ms(const estimator::Rereading& rereading) const {
  const double alone_ms = threads::count(config.threads) > 1 ? 0 : rereading.expected_ms();
  return model_cost.of(1) + gate_cost.of(1) + alone_ms;
}

/// What the strand field shows of several ropes; nothing without one, or where time is short.
std::optional<field::Axes> Estimator::Impl::axes(const Frame& frame, float rope_width_px,
                                                 const estimator::Budget& budget) {
  if (!networks.field) return std::nullopt;
  const double rope_px = estimator::magnified_px(frame, rope_width_px);
  if (budget.bounded() && !budget.leaves(reading_costs.of_field.of(rope_px))) {
    return std::nullopt;
  }
  const auto seen = field::see(frame, rope_width_px, *networks.field, true);
  return seen ? std::optional(field::axes(*seen)) : std::nullopt;
}

/// [draws] the hypothesis that conditions each.
std::vector<int> Estimator::Impl::assign(
    const std::vector<estimator::Hypothesis>& hypotheses) const {
  const int count = static_cast<int>(hypotheses.size());
  if (calibrated()) return estimator::spread_draws(count, config.draws);
  const float margin = estimator::margin(estimator::lead(hypotheses));
  return estimator::assign_draws(count, margin, config.draws);
}

Result<Estimate> Estimator::Impl::estimate(const Frame& frame, const Hints& hints, Tensors* tensors,
                                           const estimator::Budget& budget,
                                           const path::Traversals* traced) {
  if (auto valid = validate(frame); !valid) return valid.error();
  if (auto valid = estimator::check(hints, frame); !valid) return valid.error();
  const double rope_length_m = hints.rope_length_m.value_or(config.rope_length_m);
  const auto ends = estimator::end_directions(hints, frame.intrinsics);
  Timings timings;
  estimator::Stopwatch total;
  const auto conditions = estimator::gather(frame, rope_length_m, prior_kind(), timings, ends,
                                            traced);  // Sec. 3.2, 3.3
  estimator::Stopwatch stage;
  if (!conditions) return conditions.error();
  // The thesis' gate knows no doubt.
  const bool reread =
      calibrated() && estimator::worth_rereading(*conditions, frame, traced != nullptr);
  estimator::Rereading rereading(pool, reread, networks.field ? &*networks.field : nullptr,
                                 *conditions, frame, rope_length_m, prior_kind(), ends,
                                 limits(budget, timings));

  const auto& hypotheses = conditions->hypotheses;
  const bool sampled = tensors != nullptr || budget.leaves(sampling_ms(rereading));
  const auto assigned = sampled ? assign(hypotheses) : std::vector<int>{};
  std::vector<prior::Prior> draw_priors;
  std::vector<Centerline> draw_prior_nodes;
  for (const int hypothesis : assigned) {
    draw_priors.push_back(hypotheses[static_cast<std::size_t>(hypothesis)].prior);
    draw_prior_nodes.push_back(draw_priors.back().nodes);
  }
  stage.lap(timings.prior_ms);

  evidence::MaskField mask_field;
  if (sampled) mask_field = evidence::mask_field(frame);
  stage.lap(timings.mask_field_ms);

  Result<flow::Prediction> prediction = flow::Prediction{};
  if (sampled) {
    prediction = sampler.sample({.frame = frame,  // Eq. (3.26)-(3.29)
                                 .cloud = conditions->cloud,
                                 .field = mask_field,
                                 .draw_priors = draw_priors,
                                 .visible = &conditions->visible});
    if (!prediction) return prediction.error();
    timings.device_ms = sampler.stage_times_ms();
  }
  stage.lap(timings.model_ms);
  if (sampled) {
    model_cost.saw(timings.mask_field_ms + timings.model_ms, 1);
  } else {
    model_cost.left_out();
  }
  estimator::SecondLook look = rereading.finish();
  stage.lap(rereading.duration_ms() > 0 ? timings.readings_ms : timings.gate_ms);
  timings.beside_ms = std::max(0.0, rereading.duration_ms() - timings.readings_ms);

  const gate::DilatedMask mask(frame);
  auto verdict = gate::choose(prediction->draws, draw_prior_nodes, hypotheses.front().prior.nodes,
                              mask, frame.intrinsics);  // Eq. (3.30)-(3.33)
  const auto candidates =
      calibrated() ? estimator::list_candidates(look, conditions->paths.rope_width_px, *prediction,
                                                verdict.draws, assigned, frame, rope_length_m)
                   : std::vector<gate::Candidate>();
  const auto returned =
      calibrated() ? estimator::by_score(candidates, hints, *conditions, frame, rope_length_m, look)
                   : estimator::by_thesis(hypotheses, *prediction, verdict, assigned);
  const auto refined = estimator::refined(returned, candidates, frame, networks.refine);
  if (!refined) return refined.error();
  Estimate estimate =
      conclude(returned, *refined, look.hypotheses, *prediction, std::move(verdict), mask, frame);
  estimate.one_rope = gate::one_rope(estimate.nodes, frame, conditions->paths.rope_width_px);
  estimate.confidence = gate::doubted(estimate.confidence, estimate.one_rope);
  estimate.readings = look.readings;
  estimate.calibrated = calibrated();
  if (!sampled) estimate.left_out.push_back(LeftOut::kModel);
  if (look.field_left_out) estimate.left_out.push_back(LeftOut::kField);
  if (look.eroded_left_out) estimate.left_out.push_back(LeftOut::kReadings);
  estimator::turn(estimate, hints, frame.intrinsics);
  stage.lap(timings.gate_ms);
  gate_cost.saw(timings.gate_ms, 1);
  total.lap(timings.total_ms);
  estimate.timings = std::move(timings);

  if (tensors != nullptr) {
    *tensors = estimator::collect_tensors(
        sampler.source(), conditions->paths.ranked[hypotheses.front().path],
        hypotheses.front().prior, draw_priors, *prediction, mask_field);
    if (networks.field) {
      const auto seen = field::see(frame, conditions->paths.rope_width_px, *networks.field);
      if (seen) tensors->strands = estimator::seen_strands(*seen);
    }
  }
  return estimate;
}

Result<Estimator> Estimator::make(const Config& config, const VulkanHost* host) {
  return guard::guarded("Estimator::create", [&]() -> Result<Estimator> {
    auto impl = Impl::create(config, host);
    if (!impl) return impl.error();
    estimator::return_free_memory();
    return Estimator(*std::move(impl));
  });
}

Result<Estimator> Estimator::create(const Config& config) { return make(config, nullptr); }

Result<Estimator> Estimator::create(const Config& config, const VulkanHost& host) {
  return make(config, &host);
}

Result<void> Estimator::usable() const {
  if (!impl_) {
    return Error{ErrorCode::kBadInput,
                 "Estimator: expected one in use, got one that was moved from; make a new one"};
  }
  if (impl_->process != ::getpid()) {
    return Error{ErrorCode::kDeviceLost,
                 "Estimator: expected the process that made it, got one forked from there, "
                 "without its threads and device; make a new one"};
  }
  return {};
}

Result<Estimate> Estimator::run(const Frame& frame, const Hints& hints, Tensors* tensors) {
  return guard::guarded("Estimator::estimate", [&]() -> Result<Estimate> {
    if (auto fine = usable(); !fine) return fine.error();
    return impl_->estimate(frame, hints, tensors, estimator::Budget(impl_->config.budget_ms));
  });
}

Result<Ropes> Estimator::estimate_ropes(const Frame& frame) {
  return guard::guarded("Estimator::estimate_ropes", [&]() -> Result<Ropes> {
    if (auto fine = usable(); !fine) return fine.error();
    if (auto valid = validate(frame); !valid) return valid.error();
    const estimator::Budget budget(impl_->config.budget_ms);
    return estimator::estimate_each(
        frame, impl_->config.ropes,
        [&](const Frame& view, const path::Traversals* traced, double share) {
          return impl_->estimate(view, {}, nullptr, budget.part(share), traced);
        },
        [&](float rope_width_px) { return impl_->axes(frame, rope_width_px, budget); });
  });
}

Result<Frame> Estimator::fetch(const VulkanFrame& frame) {
  return guard::guarded("Estimator::fetch", [&]() -> Result<Frame> {
    if (auto fine = usable(); !fine) return fine.error();
    if (impl_->fetch) return impl_->fetch(frame);
    return Error{
        ErrorCode::kBadInput,
        "VulkanFrame: expected an estimator on the host's device, got one on its own; make "
        "it with a VulkanHost"};
  });
}

Result<Estimate> Estimator::estimate(const VulkanFrame& frame) {
  const auto fetched = fetch(frame);
  return fetched ? run(*fetched, {}, nullptr) : fetched.error();
}

Result<Estimate> Estimator::estimate(const Frame& frame) { return run(frame, {}, nullptr); }

Result<Estimate> Estimator::estimate(const Frame& frame, Tensors& tensors) {
  return run(frame, {}, &tensors);
}

Result<Estimate> Estimator::estimate(const Frame& frame, const Hints& hints) {
  return run(frame, hints, nullptr);
}

Result<Estimate> Estimator::estimate(const Frame& frame, const Hints& hints, Tensors& tensors) {
  return run(frame, hints, &tensors);
}

const std::string& Estimator::device() const {
  static const std::string none;
  return impl_ ? impl_->sampler.device() : none;
}

int Estimator::euler_steps() const { return impl_ ? impl_->config.euler_steps : 0; }
int Estimator::draws() const { return impl_ ? impl_->config.draws : 0; }

/// In a process forked from its own it is left as it is, for the system to take: its threads are
/// not there to be joined, a driver must not be called about objects of another process, and a
/// thread may have been at work in it when the process was forked.
void Estimator::LetGo::operator()(Impl* impl) const noexcept {
  if (impl->process == ::getpid()) delete impl;
}

Estimator::Estimator(std::unique_ptr<Impl> impl) : impl_(impl.release()) {}
Estimator::Estimator(Estimator&&) noexcept = default;
Estimator& Estimator::operator=(Estimator&&) noexcept = default;
Estimator::~Estimator() = default;

}  // namespace flowdlo
