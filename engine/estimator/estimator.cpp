// Estimator: the one file that sees every room. Chapter 3 of the thesis, Figure 3.1.
#include "flowdlo/estimator.hpp"

#include <unistd.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "estimator/budget.hpp"
#include "estimator/conditions.hpp"
#include "estimator/config_check.hpp"
#include "estimator/device_choice.hpp"
#include "estimator/device_networks.hpp"
#include "estimator/hints.hpp"
#include "estimator/judge.hpp"
#include "estimator/known_scene.hpp"
#include "estimator/opening.hpp"
#include "estimator/second_look.hpp"
#include "estimator/several.hpp"
#include "estimator/stopwatch.hpp"
#include "estimator/tensors.hpp"
#include "evidence/ground_depth.hpp"
#include "evidence/mask_field.hpp"
#include "field/strand_field.hpp"
#include "flow/sampler.hpp"
#include "gate/fitted.hpp"
#include "gate/gate.hpp"
#include "guard/guarded.hpp"
#include "prior/prior.hpp"
#include "threads/aside.hpp"
#include "threads/count.hpp"
#include "threads/pool.hpp"
#include "weights/kept_file.hpp"
#include "weights/location.hpp"
#include "weights/weights.hpp"

namespace flowdlo {

/// A member class is as visible as its owner unless it says otherwise.
struct FLOWDLO_HIDDEN Estimator::Impl {
  Config config;
  weights::Metadata metadata;
  estimator::DeviceNetworks networks;
  std::optional<refine::Network> refine;
  std::optional<gate::Fitted> fitted;  // where the calibrated gate decides
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
                            const estimator::Budget& budget, const estimator::Part& part = {});
  [[nodiscard]] bool calibrated() const { return fitted.has_value(); }
  [[nodiscard]] std::optional<field::Axes> axes(const Frame& frame, float rope_width_px,
                                                const estimator::Budget& budget, bool near_parts,
                                                bool& left_out);
  [[nodiscard]] std::vector<int> assign(const std::vector<estimator::Hypothesis>& hypotheses) const;
  Result<estimator::Sampled> sample(const Frame& frame, const estimator::Conditions& conditions,
                                    const gate::DilatedMask& mask, Timings& timings);
  void learn_first(const estimator::Conditions& conditions, const Timings& timings,
                   const Frame& frame);
  [[nodiscard]] estimator::ReadingLimits limits(const estimator::Budget& budget);
  [[nodiscard]] double sampling_ms(const estimator::Rereading& rereading) const;
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
  auto model = weights::keep(location->model);
  auto back_end = choice.get();
  if (!model) return model.error();
  const auto kept = std::make_shared<const weights::KeptFile>(*std::move(model));
  const Config config = estimator::resolved(wanted, kept->metadata());
  if (!back_end) return back_end.error();
  estimator::Fetch fetch = back_end->fetch;
  auto field = estimator::open_field(config, location->field);
  if (!field) return field.error();
  auto fitted = estimator::open_gate(config, *kept, field->calibration);
  if (!fitted) return fitted.error();
  const bool draws_idle = estimator::draws_idle(fitted->has_value(), field->field != nullptr);
  auto networks = estimator::DeviceNetworks::create(
      {.config = config,
       .model = estimator::source_of(kept),
       .model_idle = draws_idle && config.quality != Quality::kFull,
       .field = field->field},
      *std::move(back_end));
  if (!networks) return networks.error();
  auto impl = std::unique_ptr<Impl>(  // an aggregate, which Clang 14 makes by braces only
      new Impl{config, kept->metadata(), *std::move(networks), std::move(field->refine),
               *std::move(fitted)});
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

/// What a frame's reading took is what the next frame's is expected to take.
void Estimator::Impl::learn_first(const estimator::Conditions& conditions, const Timings& timings,
                                  const Frame& frame) {
  estimator::Cost& cost = conditions.axes ? reading_costs.of_field : reading_costs.of_mask;
  cost.saw(timings.field_ms + timings.path_ms + timings.prior_ms,
           estimator::magnified_px(frame, conditions.paths.rope_width_px));
}

estimator::ReadingLimits Estimator::Impl::limits(const estimator::Budget& budget) {
  if (!budget.bounded()) return {};
  return {&budget, &reading_costs, gate_cost.of(1)};
}

/// What the model, and all that has to follow, will take. Readings come first where they have no
/// thread of their own: they change more estimates than the model does.
double Estimator::Impl::sampling_ms(const estimator::Rereading& rereading) const {
  const double alone_ms = threads::count(config.threads) > 1 ? 0 : rereading.expected_ms();
  return model_cost.of(1) + gate_cost.of(1) + alone_ms;
}

/// What the strand field shows; nothing without one, or where it and the mask, which may have to
/// follow, would take too long: it is `left_out`.
std::optional<field::Axes> Estimator::Impl::axes(const Frame& frame, float rope_width_px,
                                                 const estimator::Budget& budget, bool near_parts,
                                                 bool& left_out) {
  if (networks.field() == nullptr) return std::nullopt;
  const double rope_px = budget.bounded() ? estimator::magnified_px(frame, rope_width_px) : 0;
  const double to_come_ms = reading_costs.of_mask.of(rope_px) + gate_cost.of(1);
  left_out = !budget.leaves(reading_costs.of_field.of(rope_px) + to_come_ms);
  if (left_out) {
    reading_costs.of_field.left_out();
    return std::nullopt;
  }
  return estimator::seen_by(networks.field(), near_parts, &pool)(frame, rope_width_px);
}

/// [draws] the hypothesis that conditions each.
std::vector<int> Estimator::Impl::assign(
    const std::vector<estimator::Hypothesis>& hypotheses) const {
  const int count = static_cast<int>(hypotheses.size());
  if (calibrated()) return estimator::spread_draws(count, config.draws);
  const float margin = estimator::margin(estimator::lead(hypotheses));
  return estimator::assign_draws(count, margin, config.draws);
}

/// The model's draws, each of the hypothesis that it is given, and what the thesis' gate says.
Result<estimator::Sampled> Estimator::Impl::sample(const Frame& frame,
                                                   const estimator::Conditions& conditions,
                                                   const gate::DilatedMask& mask,
                                                   Timings& timings) {
  estimator::Stopwatch stage;
  estimator::Sampled sampled{.assigned = assign(conditions.hypotheses)};
  std::vector<prior::Prior> priors;
  std::vector<Centerline> prior_nodes;
  for (const int hypothesis : sampled.assigned) {
    priors.push_back(conditions.hypotheses[static_cast<std::size_t>(hypothesis)].prior);
    prior_nodes.push_back(priors.back().nodes);
  }
  sampled.mask_field = evidence::mask_field(frame);
  stage.lap(timings.mask_field_ms);
  auto prediction = networks.sample({.frame = frame,  // Eq. (3.26)-(3.29)
                                     .cloud = conditions.cloud,
                                     .field = sampled.mask_field,
                                     .draw_priors = priors,
                                     .visible = &conditions.visible});
  stage.lap(timings.model_ms);
  if (!prediction) return prediction.error();
  timings.device_ms = networks.stage_times_ms();
  model_cost.saw(timings.mask_field_ms + timings.model_ms, 1);
  sampled.prediction = *std::move(prediction);
  sampled.verdict = gate::choose(sampled.prediction.draws, prior_nodes,
                                 conditions.hypotheses.front().prior.nodes, mask, frame.intrinsics);
  stage.lap(timings.gate_ms);
  return sampled;
}

/// The field first. Where that leaves doubt, a closer look through it and the mask alone, and the
/// model beside them; then the choice. Expects a valid frame.
Result<Estimate> Estimator::Impl::estimate(const Frame& given, const Hints& hints, Tensors* tensors,
                                           const estimator::Budget& budget,
                                           const estimator::Part& part) {
  if (auto valid = estimator::check(hints, given); !valid) return valid.error();
  Timings timings;
  estimator::Stopwatch total;
  estimator::Stopwatch stage;
  const auto ground_m = evidence::ground_depth(given);  // of a rope that shows none
  stage.lap(timings.evidence_ms);
  Frame frame = given;
  if (ground_m) frame.depth_m = *ground_m;
  const estimator::ReadConfig reading{
      estimator::prior_kind(config, metadata), hints.rope_length_m.value_or(config.rope_length_m),
      estimator::end_directions(hints, frame.intrinsics), hints.closed, &pool};
  networks.begin_frame();
  bool hurry = false;  // a look of the strand field was left out
  const auto see = [&](const Frame& of, float px) { return axes(of, px, budget, false, hurry); };
  auto conditions = estimator::gather(frame, reading, timings, part.traced,  // Sec. 3.2, 3.3
                                      networks.field() != nullptr ? see : estimator::SeeAxes());
  if (!conditions) return conditions.error();
  frame = estimator::read_frame(frame, *conditions);

  stage = {};
  const gate::DilatedMask mask(frame);
  const estimator::Judge judge(fitted ? &*fitted : nullptr, hints, *conditions, frame,
                               reading.rope_length_m, refine ? &*refine : nullptr, part.in_all);
  auto first = judge.of_first(part.traced != nullptr);
  if (!first) return first.error();
  stage.lap(timings.gate_ms);

  const bool doubtful = calibrated() && !*first;  // the thesis' gate knows no doubt
  if (budget.bounded()) learn_first(*conditions, timings, frame);
  stage = {};
  estimator::Rereading rereading(pool, doubtful, networks.field(), *conditions, frame, reading,
                                 limits(budget));
  const bool draws_idle = estimator::draws_idle(calibrated(), conditions->seen.has_value());
  const bool wanted = tensors != nullptr || config.quality == Quality::kFull || !draws_idle;
  const bool asked = wanted && (tensors != nullptr || budget.leaves(sampling_ms(rereading)));
  estimator::Sampled sampled;
  if (asked) {
    auto drawn = sample(frame, *conditions, mask, timings);
    if (!drawn) return drawn.error();
    sampled = *std::move(drawn);
    stage = {};
  } else if (wanted) {
    model_cost.left_out();
  }
  estimator::SecondLook look = *first ? (*first)->look : rereading.finish();
  stage.lap(rereading.duration_ms() > 0 ? timings.readings_ms : timings.gate_ms);
  timings.beside_ms = std::max(0.0, rereading.duration_ms() - timings.readings_ms);

  std::vector<LeftOut> left_out;
  if (wanted && !asked) left_out.push_back(LeftOut::kModel);
  if (hurry && !conditions->axes) left_out.push_back(LeftOut::kField);
  if (look.left_out || (hurry && conditions->axes)) left_out.push_back(LeftOut::kReadings);
  auto judged = *first && !asked ? Result<estimator::Judged>(**std::move(first))
                                 : judge.of_all(std::move(look), sampled);
  if (!judged) return judged.error();
  Estimate estimate =
      estimator::conclude(*std::move(judged), std::move(sampled.verdict.draws), mask, frame);
  estimate.calibrated = calibrated();
  estimate.left_out = std::move(left_out);
  if (ground_m) estimator::doubt_depth(estimate);
  estimator::turn(estimate, hints, frame.intrinsics);
  stage.lap(timings.gate_ms);
  gate_cost.saw(timings.gate_ms, 1);
  total.lap(timings.total_ms);
  estimate.timings = std::move(timings);
  if (tensors != nullptr) {
    *tensors = estimator::collect_tensors(networks.source(), *conditions, sampled);
    if (networks.field() != nullptr) {
      const auto seen = field::see(frame, conditions->paths.rope_width_px, *networks.field());
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
    if (auto valid = validate(frame); !valid) return valid.error();
    return impl_->estimate(frame, hints, tensors, estimator::Budget(impl_->config.budget_ms));
  });
}

Result<Ropes> Estimator::estimate_ropes(const Frame& frame) { return estimate_ropes(frame, {}); }

Result<Ropes> Estimator::estimate_ropes(const Frame& frame, const std::vector<KnownRope>& before) {
  return guard::guarded("Estimator::estimate_ropes", [&]() -> Result<Ropes> {
    if (auto fine = usable(); !fine) return fine.error();
    if (auto valid = validate(frame); !valid) return valid.error();
    const estimator::Budget budget(impl_->config.budget_ms);
    bool looked = false;
    bool closer_left_out = false;
    auto ropes = estimator::estimate_each(
        frame, impl_->config.ropes,
        [&](const Frame& view, const estimator::Part& part, double share) {
          return impl_->estimate(view, part.hints, nullptr, budget.part(share), part);
        },
        [&](const Frame& seen, float rope_width_px) {
          // What tells ropes apart is never left out: by the mask alone there are other ropes, and
          // each of them takes longer.
          bool left_out = false;
          auto axes = impl_->axes(seen, rope_width_px, looked ? budget : estimator::Budget(0), true,
                                  left_out);
          closer_left_out = closer_left_out || left_out;
          looked = true;
          return axes;
        },
        before);
    if (!ropes || !closer_left_out) return ropes;
    for (Estimate& rope : ropes->ropes) rope.left_out.push_back(LeftOut::kReadings);
    return ropes;
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
  static const std::string none;  // of what was moved from
  return impl_ ? impl_->networks.device() : none;
}

const std::string& Estimator::field_device() const {
  static const std::string none;
  return impl_ ? impl_->networks.field_device() : none;
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
