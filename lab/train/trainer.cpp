#include "train/trainer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "train/batch.hpp"
#include "train/curves.hpp"
#include "train/device.hpp"
#include "train/loader.hpp"
#include "train/objective.hpp"
#include "train/validation.hpp"

namespace flowdlo::train {
namespace {

using torch::Tensor;

ViewConfig view_of(const TrainingState& state) {
  return {state.recipe.variant.normalization, state.norm, state.recipe.sampling.truth_direction};
}

void set_rate(torch::optim::AdamW& optimizer, double rate, double head_factor) {
  auto& groups = optimizer.param_groups();
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const double factor = i == kHeadGroup ? head_factor : 1;
    static_cast<torch::optim::AdamWOptions&>(groups[i].options()).lr(rate * factor);
  }
}

/// Norm of the whole gradient; scales it down to `limit` where that is above zero.
double clip(const std::vector<Tensor>& parameters, double limit) {
  std::vector<Tensor> norms;
  for (const Tensor& parameter : parameters) {
    if (parameter.grad().defined()) norms.push_back(parameter.grad().norm());
  }
  const double total = torch::stack(norms).norm().item<double>();
  if (limit > 0 && total > limit) {
    for (const Tensor& parameter : parameters) {
      if (parameter.grad().defined()) parameter.grad().mul_(limit / total);
    }
  }
  return total;
}

void average(VelocityModelImpl& average, const VelocityModelImpl& model, double decay) {
  const torch::NoGradGuard no_gradients;
  const auto from = model.parameters();
  auto to = average.parameters();
  for (std::size_t i = 0; i < to.size(); ++i) to[i].lerp_(from[i], 1 - decay);
}

/// What one run holds beside the state: records, loader, log.
class Run {
 public:
  Run(TrainingState& state, const RunOptions& options, torch::Device device)
      : state_(state), options_(options), device_(device) {}

  Result<void> prepare();
  Result<void> go();

 private:
  Result<void> take_records(std::uint32_t shards);
  Result<void> keep_checkpoint();
  void validate();
  void note(const std::string& line) const {
    if (options_.on_note) options_.on_note(line);
  }

  TrainingState& state_;
  const RunOptions& options_;
  torch::Device device_;
  std::shared_ptr<const RecordSet> training_;
  RecordSet validation_;
  std::unique_ptr<Loader> loader_;
  std::optional<TrainingLog> log_;
};

Result<void> Run::take_records(std::uint32_t shards) {
  auto loaded = load_records(options_.records, Part::kTraining, shards);
  if (!loaded) return loaded.error();
  loader_.reset();
  training_ = std::make_shared<const RecordSet>(*std::move(loaded));
  if (state_.step == 0) state_.norm = global_norm(training_->records);
  state_.shards = training_->shards;
  state_.data_sha256 = training_->sha256;
  state_.data_origin = fmt::format("{}, {} scenes, {} without a path", training_->origin,
                                   training_->scenes, training_->skipped);
  loader_ = std::make_unique<Loader>(training_, state_.recipe, view_of(state_),
                                     static_cast<std::uint64_t>(state_.step),
                                     std::max(1, options_.loader_threads));
  note(fmt::format("step {}: {} training records ({})", state_.step, training_->records.size(),
                   state_.data_origin));
  return {};
}

Result<void> Run::prepare() {
  const bool fresh = state_.step == 0;
  const std::uint32_t shards = fresh ? 0xFFFFFFFFU : state_.shards;
  if (auto taken = take_records(shards); !taken) return taken;
  auto validation = load_records(options_.records, Part::kValidation);
  if (!validation) return validation.error();
  validation_ = *std::move(validation);
  auto log = TrainingLog::open(options_.folder, state_.step);
  if (!log) return log.error();
  log_ = *std::move(log);
  const auto& wanted = state_.recipe.optimizer.precision;
  if (wanted == Precision::kBf16 && compute_type(wanted, device_) != torch::kBFloat16) {
    note("computing in f32: this processor has no AVX-512, without which bf16 is far slower");
  }
  if (fresh) validate();
  return {};
}

void Run::validate() {
  const auto groups = validate_model(
      state_.best(), validation_.records, view_of(state_), state_.recipe.schedule.euler_steps,
      compute_type(state_.recipe.optimizer.precision, device_), device_);
  log_->add(state_.step, groups);
  state_.validation = table_of(groups);
  note(fmt::format("step {}: validation\n{}", state_.step, state_.validation));
}

Result<void> Run::keep_checkpoint() {
  const auto grown = count_shards(options_.records, Part::kTraining);
  if (options_.grow && grown > state_.shards) {
    if (auto taken = take_records(grown); !taken) return taken;
  }
  auto saved = save_checkpoint(state_, options_.folder / "checkpoint.pt");
  if (!saved) return saved;
  return plot_curves(options_.folder);
}

Result<void> Run::go() {
  const auto& schedule = state_.recipe.schedule;
  const std::int64_t end = state_.recipe.optimizer.steps;
  const std::int64_t last =
      options_.stop_after > 0 ? std::min(end, state_.step + options_.stop_after) : end;
  auto before = std::chrono::steady_clock::now();
  while (state_.step < last) {
    StepReport report = train_step(state_, loader_->next().to(device_));
    if (!std::isfinite(report.total)) {
      return Error{ErrorCode::kInternal,
                   fmt::format("step {}: expected a finite loss, got {}; resume from the last "
                               "checkpoint with a lower rate",
                               report.step, report.total)};
    }
    const auto now = std::chrono::steady_clock::now();
    report.records_per_s =
        state_.recipe.optimizer.batch / std::chrono::duration<double>(now - before).count();
    report.records = training_->records.size();
    log_->add(report);
    if (options_.on_step) options_.on_step(report);
    const bool ends = state_.step == last;
    if (state_.step % schedule.validate_every == 0 || state_.step == end) validate();
    if (state_.step % schedule.checkpoint_every == 0 || ends) {
      if (auto kept = keep_checkpoint(); !kept) return kept;
    }
    before = std::chrono::steady_clock::now();
  }
  return {};
}

}  // namespace

double learning_rate(const OptimizerConfig& config, std::int64_t step) {
  if (step < config.warmup_steps) {
    return config.rate * static_cast<double>(step + 1) / config.warmup_steps;
  }
  const double length = std::max(1, config.steps - config.warmup_steps);
  const double share = std::min(1.0, static_cast<double>(step - config.warmup_steps) / length);
  return config.final_rate +
         (config.rate - config.final_rate) * 0.5 * (1 + std::cos(std::numbers::pi * share));
}

double average_decay(double decay, std::int64_t step) {
  const auto n = static_cast<double>(step);
  return std::min(decay, (1 + n) / (10 + n));
}

StepReport train_step(TrainingState& state, const Batch& batch) {
  const auto& recipe = state.recipe;
  StepReport report;
  report.rate = learning_rate(recipe.optimizer, state.step);
  set_rate(*state.optimizer, report.rate, recipe.optimizer.head_rate);
  state.optimizer->zero_grad();
  const torch::ScalarType type =
      compute_type(recipe.optimizer.precision, batch.target.truth.device());
  const Tensor output = state.model->forward(batch.input, type);
  const Losses losses = objective(recipe.variant, recipe.objective, output, batch.target);
  losses.total.backward();
  report.gradient_norm = clip(state.model->parameters(), recipe.optimizer.clip_norm);
  state.optimizer->step();
  if (state.average) {
    average(*state.average, *state.model, average_decay(recipe.optimizer.ema_decay, state.step));
  }
  report.step = ++state.step;
  report.total = losses.total.item<double>();
  report.primary = losses.primary.item<double>();
  report.prior = losses.prior.item<double>();
  report.spacing = losses.spacing.item<double>();
  report.bending = losses.bending.item<double>();
  report.harm = losses.harm.item<double>();
  report.sigma = losses.sigma.item<double>();
  return report;
}

Result<void> train(TrainingState& state, const RunOptions& options, torch::Device device) {
  Run run(state, options, device);
  if (auto prepared = run.prepare(); !prepared) return prepared;
  return run.go();
}

}  // namespace flowdlo::train
