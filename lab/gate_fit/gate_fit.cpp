// flowdlo-lab gate-fit fit: fits the calibrated gate on synthetic training frames and writes the
// model's weights, or the strand field's, with it. flowdlo-lab gate-fit report: what the gate is
// worth on frames that it was not fitted on.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command/report_commands.hpp"
#include "command_line.hpp"
#include "flowdlo/weights.hpp"
#include "gate/fitted.hpp"
#include "gate_fit/fit.hpp"
#include "gate_fit/gather.hpp"
#include "gate_fit/report.hpp"
#include "gate_fit/sample.hpp"
#include "survey/failed.hpp"
#include "weights/fdw.hpp"
#include "weights/field_weights.hpp"
#include "weights/weights.hpp"

namespace {

namespace lab = flowdlo::lab;
using flowdlo::Error;
using flowdlo::Result;
using flowdlo::survey::failed;

constexpr int kLeastScenes = 50;

struct Options {
  lab::GatherConfig gather;
  std::string out;
  int scenes = 1000;
  int more = 0;
  bool keep_choice = false;
  bool keep_draws = false;
};

/// Those of frames that a strand field was asked about: what it says of others is not weighed.
void keep_seen(lab::Samples& samples) {
  std::erase_if(
      samples, [](const lab::GateSample& sample) { return !sample.candidates.front().axes.known; });
}

Error no_calibration(const std::string& file) {
  return {
      flowdlo::ErrorCode::kBadWeights,
      fmt::format("{}: expected weights with a section \"calibration\", got none; fit one first, "
                  "without --keep-choice and --keep-draws",
                  file)};
}

/// What the weights that are fitted to hold so far: the field's, or without one the model's. Fails
/// where they hold nothing of which the options ask to keep a part.
Result<std::optional<flowdlo::gate::GateWeights>> fitted_before(const Options& options) {
  const auto model = lab::open_model(options.gather);
  if (!model) return model.error();
  const auto& before = model->field ? model->field->calibration : model->weights->calibration;
  if (before) return std::optional(flowdlo::gate::gate_weights(*before));
  if (!options.keep_choice && !options.keep_draws) {
    return std::optional<flowdlo::gate::GateWeights>();
  }
  return no_calibration(model->field ? options.gather.field : options.gather.weights);
}

/// The same weights with another calibration, as options.out.
Result<void> write_fitted(const Options& options, flowdlo::weights::Calibration calibration) {
  if (options.gather.field.empty()) {
    auto model = flowdlo::weights::read_fdw(options.gather.weights);
    if (!model) return model.error();
    model->weights.calibration = std::move(calibration);
    return flowdlo::weights::write_fdw(model->weights, model->types, options.out);
  }
  auto field = flowdlo::weights::load_field(options.gather.field);
  if (!field) return field.error();
  field->calibration = std::move(calibration);
  return flowdlo::weights::save_field(*field, options.out);
}

int fit(const Options& options) {
  const auto before = fitted_before(options);  // before anything is measured
  if (!before) return failed(before.error());
  const auto& kept = *before;
  auto samples = lab::with_model(options.gather, options.scenes);
  if (!samples) return failed(samples.error());
  auto more = lab::without_model(options.gather, options.more);
  if (!more) return failed(more.error());
  auto also = lab::beside_split(options.gather, options.more);
  if (!also) return failed(also.error());
  const bool seen = !options.gather.field.empty();
  if (seen) {
    for (lab::Samples* of : {&*samples, &*more, &*also}) keep_seen(*of);
  }
  lab::Samples all = *samples;
  all.insert(all.end(), more->begin(), more->end());
  const lab::GateFit fitted = lab::fit_gate(all, *also, options.keep_choice ? &*kept : nullptr);
  const lab::Unseen& unseen = fitted.unseen;
  auto weights = fitted.weights;
  if (options.keep_draws) {
    weights.draw = kept->draw;
    weights.draw_margin = kept->draw_margin;
  }
  const auto info = flowdlo::inspect_weights(options.gather.weights);
  const std::string notes = fmt::format(
      "{}{} on {} scenes of {} {} from {}, and without a model {} and {} of other "
      "kinds; weights {}...",
      options.keep_choice ? "choice kept; confidence and sigma_m fitted" : "fitted",
      options.keep_draws ? ", weights of draws kept," : "", samples->size(), options.gather.split,
      options.gather.part, options.gather.first, more->size(), also->size(),
      info ? info->sha256.substr(0, 16) : "unknown");
  const auto written = write_fitted(options, flowdlo::gate::calibration_of(weights, notes));
  if (!written) return failed(written.error());
  fmt::print(
      stderr,
      "Of the {} scenes of {}, each by a fit that did not see it, at most {:.0f} cm each: first "
      "prior {:.3f} cm, chosen {:.3f}, best {:.3f}.\n\n{}",
      all.size(), options.gather.split, 100 * lab::kMostError_m, unseen.first_cm, unseen.chosen_cm,
      unseen.best_cm,
      lab::report(
          *samples, [&](auto) -> const auto& { return weights; }));
  return 0;
}

int report(const Options& options) {
  const auto model = lab::open_model(options.gather);
  if (!model) return failed(model.error());
  if (!model->fitted) return failed(no_calibration(options.gather.weights));
  const auto samples = lab::with_model(options.gather, options.scenes);
  if (!samples) return failed(samples.error());
  fmt::print("{}", lab::report(
                       *samples, [&](auto of) -> const auto& { return model->fitted->of(of); }));
  return 0;
}

void add_options(CLI::App& command, Options& options) {
  command.add_option("--weights", options.gather.weights, "Weights of the model, .fdw")
      ->required()
      ->check(CLI::ExistingFile);
  command.add_option("--field", options.gather.field, "Weights of a strand field, .safetensors")
      ->check(CLI::ExistingFile);
  command
      .add_option(
          "--cache", options.gather.cache,
          "Keep what was measured in NAME.jsonl and NAME_*.jsonl; remove them when path or prior "
          "change")
      ->type_name("NAME");
  command.add_option("--split", options.gather.split, "wide or thesis")
      ->check(CLI::IsMember({"wide", "thesis"}))
      ->capture_default_str();
  command.add_option("--scenes", options.scenes, "How many")
      ->check(CLI::Range(kLeastScenes, 1000000))
      ->capture_default_str();
  command.add_option("--first", options.gather.first, "Index of the first")->capture_default_str();
  command.add_option("--threads", options.gather.threads, "Of the CPU back end; 0: one a core")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command.add_option("--draws", options.gather.draws, "As the estimator is used")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command.add_option("--steps", options.gather.steps, "Euler steps")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command.add_flag("--unrefined", options.gather.unrefined,
                   "Leave nodes where the prior has them, whatever the strand field's file holds");
  command.add_flag("--quiet", options.gather.quiet, "No progress bar");
}

}  // namespace

namespace flowdlo::lab {

void add_gate_fit(CLI::App& program, support::ExitCode& exit_code) {
  auto& app = *support::add_command(program, "gate-fit",
                                    "The calibrated gate on synthetic frames with truth");
  app.require_subcommand(1);
  auto fitting = std::make_shared<Options>();
  auto* fit_command = support::add_command(app, "fit", "Fit to a model on training frames");
  add_options(*fit_command, *fitting);
  fit_command
      ->add_option("--more", fitting->more,
                   "Scenes beyond those, for what does not depend on the model; quick")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  fit_command
      ->add_option(
          "--out", fitting->out,
          "The weights with what was fitted: a .safetensors where --field is given, else a "
          ".fdw")
      ->required()
      ->type_name("FILE");
  fit_command->add_flag("--keep-choice", fitting->keep_choice,
                        "Fit confidence and sigma_m alone, to what those weights choose so far");
  fit_command->add_flag("--keep-draws", fitting->keep_draws,
                        "Weigh draws as those weights do so far");
  support::set_action(*fit_command, exit_code, [fitting] { return ::fit(*fitting); });

  auto reporting = std::make_shared<Options>();
  reporting->gather.part = "validation";
  reporting->gather.first = 0;
  reporting->scenes = 300;
  auto* report_command =
      support::add_command(app, "report", "What the gate of the weights is worth");
  add_options(*report_command, *reporting);
  report_command->add_option("--part", reporting->gather.part, "training or validation")
      ->check(CLI::IsMember({"training", "validation"}))
      ->capture_default_str();
  support::set_action(*report_command, exit_code, [reporting] { return ::report(*reporting); });
}

}  // namespace flowdlo::lab
