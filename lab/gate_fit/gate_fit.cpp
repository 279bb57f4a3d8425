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
#include "estimator/device_choice.hpp"
#include "field/network.hpp"
#include "flowdlo/weights.hpp"
#include "gate/fitted.hpp"
#include "gate_fit/fit.hpp"
#include "gate_fit/report.hpp"
#include "gate_fit/sample.hpp"
#include "gate_fit/sample_file.hpp"
#include "progress_bar.hpp"
#include "reference/program.hpp"
#include "refine/network.hpp"
#include "survey/failed.hpp"
#include "survey/in_parallel.hpp"
#include "weights/fdw.hpp"
#include "weights/field_weights.hpp"
#include "weights/weights.hpp"

namespace {

namespace lab = flowdlo::lab;
namespace synth = flowdlo::synth;
using flowdlo::Error;
using flowdlo::Result;
using flowdlo::survey::failed;
using Samples = std::vector<lab::GateSample>;

constexpr std::uint64_t kFirstUntrained = 1000000;  // training takes its scenes from the front
constexpr int kLeastScenes = 50;
constexpr std::uint64_t kLengthKnownEvery = 4;
constexpr std::uint64_t kApart = 500000;  // between scenes with and without the model
constexpr int kCleanShare = 4;  // one of the thesis split, and one drawn, on so many of the others
constexpr std::uint64_t kBareEvery = 12;  // frames of which one, two or three lack something
constexpr int kPixels = 1280 * 720;

struct Options {
  std::string weights;
  std::string field;
  std::string cache;
  std::string out;
  std::string split = "wide";
  std::string part = "training";
  int scenes = 1000;
  int more = 0;
  std::uint64_t first = kFirstUntrained;
  int threads = 1;
  int draws = 4;
  int steps = 10;
  bool quiet = false;
  bool keep_choice = false;
  bool keep_draws = false;
  bool unrefined = false;
};

/// Scenes of one split and part, with or without the model.
struct Batch {
  lab::SampleOrigin origin;
  int scenes = 0;
  std::string file;   ///< empty: keep nothing
  bool bare = false;  ///< some frames lack what some cameras do not give
};

/// Every so many training frames come with the rope's length, so that the fit learns what it is
/// worth.
double known_length_m(const lab::SampleOrigin& origin, std::uint64_t index, double length_m) {
  return origin.part == "training" && index % kLengthKnownEvery == 0 ? length_m : 0;
}

/// Some frames come without a picture, some with depth on the mask alone, some with neither: what
/// a strand field says of them is weighed as well.
void lay_bare(flowdlo::FrameFolder& frame, std::uint64_t index) {
  const std::uint64_t turn = index % kBareEvery;
  const bool both = turn == 5;
  if (both || turn == 1 || turn == 7) frame.color_bgr.clear();
  if (!both && turn != 3 && turn != 9) return;
  for (std::size_t i = 0; i < frame.depth_m.size(); ++i) {
    if (frame.mask[i] == 0) frame.depth_m[i] = 0;
  }
}

struct Model {
  std::shared_ptr<const flowdlo::weights::Weights> weights;
  std::optional<flowdlo::flow::Sampler> sampler;                ///< none: priors alone
  std::shared_ptr<const flowdlo::weights::FieldWeights> field;  ///< null: none
  std::optional<flowdlo::gate::Fitted> fitted;                  ///< none: nothing is sure
};

Result<Model> open_model(const Options& options, bool with_sampler) {
  auto loaded = flowdlo::weights::load(options.weights);
  if (!loaded) return loaded.error();
  Model model;
  model.weights = std::make_shared<const flowdlo::weights::Weights>(*std::move(loaded));
  if (!options.field.empty()) {
    auto field = flowdlo::weights::load_field(options.field);
    if (!field) return field.error();
    model.field = std::make_shared<const flowdlo::weights::FieldWeights>(*std::move(field));
  }
  model.fitted = flowdlo::gate::Fitted::of_weights(
      model.weights->calibration, model.field ? model.field->calibration : std::nullopt);
  if (!with_sampler) return model;
  const auto back_end = flowdlo::estimator::cpu_back_end(options.threads);
  auto sampler = flowdlo::flow::Sampler::create(
      model.weights, back_end.make_program,
      {.draws = options.draws,
       .steps = options.steps,
       .capacity = {
           .cloud_points = kPixels / 4, .field_texels = kPixels / 4, .image_pixels = kPixels}});
  if (!sampler) return sampler.error();
  model.sampler = *std::move(sampler);
  return model;
}

/// One thread's own.
struct Networks {
  std::optional<flowdlo::field::Network> field{};
  std::optional<flowdlo::refine::Network> refine{};
};

/// None without weights.
Result<Networks> networks_of(const Model& model, bool unrefined) {
  Networks networks;
  if (!model.field) return networks;
  const auto make_program = [] { return flowdlo::reference::create_program(1); };
  auto field = flowdlo::field::Network::create(model.field, make_program);
  if (!field) return field.error();
  networks.field = *std::move(field);
  if (unrefined || !model.field->refine) return networks;
  auto refine = flowdlo::refine::Network::create(*model.field->refine, make_program);
  if (!refine) return refine.error();
  networks.refine = *std::move(refine);
  return networks;
}

/// A split that ends goes on with its next seed.
Result<synth::SyntheticFrame> scene_of(const lab::SampleOrigin& origin, std::uint64_t index,
                                       bool color) {
  const synth::Split split = *synth::split_of(origin.split);
  const synth::Part part = *synth::part_of(origin.part);
  const std::uint64_t count = synth::scene_count(split, part);
  return synth::make_frame(split, part, count > 0 ? index / count : 0,
                           count > 0 ? index % count : index, {.color = color});
}

using Measured = Result<std::optional<lab::GateSample>>;

Measured measured_one(const Options& options, const Batch& batch, Model& model, Networks& networks,
                      std::uint64_t number) {
  const std::uint64_t index = batch.origin.first + number;
  // Colours take longest, and nothing but the strand field asks for them.
  auto scene = scene_of(batch.origin, index, networks.field.has_value());
  if (!scene) return scene.error();
  if (batch.bare) lay_bare(scene->folder, index);
  const auto kind = model.weights->metadata.variant.prior_kind;
  const double length_m = known_length_m(batch.origin, index, scene->meta.length_m);
  return lab::measure(*scene, model.sampler ? &*model.sampler : nullptr,
                      networks.field ? &*networks.field : nullptr,
                      networks.refine ? &*networks.refine : nullptr,
                      model.fitted ? &*model.fitted : nullptr, options.draws, kind, length_m);
}

/// Scenes `done` and later; several at a time where there is no model, which takes threads itself.
Result<Samples> measured(const Options& options, const Batch& batch, int done) {
  auto model = open_model(options, batch.origin.draws > 0);
  if (!model) return model.error();
  flowdlo::support::ProgressBar bar(batch.origin.draws > 0 ? "scenes" : "scenes without model",
                                    batch.scenes - done, options.quiet);
  const int threads = model->sampler ? 1 : flowdlo::threads::cores();
  Samples samples;
  for (auto& one : flowdlo::survey::in_parallel<std::optional<lab::GateSample>>(
           {static_cast<std::uint64_t>(done), static_cast<std::uint64_t>(batch.scenes - done)},
           threads, [&] { return networks_of(*model, options.unrefined); },
           [&](Networks&networks, std::uint64_t number) {
             return measured_one(options, batch, *model, networks, number);
           },
           [&] { bar.advance(); })) {
    if (!one) return one.error();
    if (*one) samples.push_back(**std::move(one));
  }
  return samples;
}

/// From the file as far as it reaches, the rest anew.
Result<Samples> samples_of(const Options& options, const Batch& batch) {
  lab::SampleFile kept;
  if (!batch.file.empty()) {
    auto read = lab::read_samples(batch.file, batch.origin);
    if (!read) return read.error();
    kept = *std::move(read);
  }
  if (kept.scenes < batch.scenes) {
    auto more = measured(options, batch, kept.scenes);
    if (!more) return more.error();
    kept.samples.insert(kept.samples.end(), more->begin(), more->end());
    kept.scenes = batch.scenes;
    if (!batch.file.empty()) {
      auto written = lab::write_samples(batch.file, batch.origin, kept);
      if (!written) return written.error();
    }
  }
  std::erase_if(kept.samples, [&](const lab::GateSample& sample) {
    return sample.index >= batch.origin.first + static_cast<std::uint64_t>(batch.scenes);
  });
  return std::move(kept.samples);
}

std::string field_of(const Options& options) {
  if (options.field.empty()) return "";
  const auto weights = flowdlo::weights::load_field(options.field);
  if (!weights) return "";
  const bool refines = weights->refine && !options.unrefined;
  return weights->notes + (refines ? "; refined: " + weights->refine->notes : "");
}

Result<Samples> with_model(const Options& options) {
  const auto info = flowdlo::inspect_weights(options.weights);
  if (!info) return info.error();
  return samples_of(options, {.origin = {.weights_sha256 = info->sha256,
                                         .field = field_of(options),
                                         .split = options.split,
                                         .part = options.part,
                                         .first = options.first,
                                         .draws = options.draws,
                                         .steps = options.steps},
                              .scenes = options.scenes,
                              .file = options.cache.empty() ? "" : options.cache + ".jsonl"});
}

Result<Samples> without_model(const Options& options) {
  if (options.more == 0) return Samples{};
  return samples_of(options, {.origin = {.weights_sha256 = "",
                                         .field = field_of(options),
                                         .split = options.split,
                                         .part = options.part,
                                         .first = options.first + kApart},
                              .scenes = options.more,
                              .file = options.cache.empty() ? "" : options.cache + "_priors.jsonl",
                              .bare = true});
}

/// Table-top scenes with clean depth, so that what is sure counts as well.
Result<Samples> clean_without_model(const Options& options) {
  if (options.more == 0) return Samples{};
  return samples_of(options,
                    {.origin = {.weights_sha256 = "",
                                .field = field_of(options),
                                .split = "thesis",
                                .part = options.part},
                     .scenes = options.more / kCleanShare,
                     .file = options.cache.empty() ? "" : options.cache + "_thesis.jsonl"});
}

/// Plain tubes before nothing, so that a frame that shows no more than a rope counts as well.
Result<Samples> drawn_without_model(const Options& options) {
  if (options.more == 0) return Samples{};
  return samples_of(options, {.origin = {.weights_sha256 = "",
                                         .field = field_of(options),
                                         .split = "drawn",
                                         .part = options.part},
                              .scenes = options.more / kCleanShare,
                              .file = options.cache.empty() ? "" : options.cache + "_drawn.jsonl",
                              .bare = true});
}

/// Those of frames that a strand field was asked about: what it says of others is not weighed.
void keep_seen(Samples& samples) {
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
  const auto model = open_model(options, false);
  if (!model) return model.error();
  const auto& before = model->field ? model->field->calibration : model->weights->calibration;
  if (before) return std::optional(flowdlo::gate::gate_weights(*before));
  if (!options.keep_choice && !options.keep_draws) {
    return std::optional<flowdlo::gate::GateWeights>();
  }
  return no_calibration(model->field ? options.field : options.weights);
}

/// The same weights with another calibration, as options.out.
Result<void> write_fitted(const Options& options, flowdlo::weights::Calibration calibration) {
  if (options.field.empty()) {
    auto model = flowdlo::weights::read_fdw(options.weights);
    if (!model) return model.error();
    model->weights.calibration = std::move(calibration);
    return flowdlo::weights::write_fdw(model->weights, model->types, options.out);
  }
  auto field = flowdlo::weights::load_field(options.field);
  if (!field) return field.error();
  field->calibration = std::move(calibration);
  return flowdlo::weights::save_field(*field, options.out);
}

int fit(const Options& options) {
  const auto before = fitted_before(options);  // before anything is measured
  if (!before) return failed(before.error());
  const auto& kept = *before;
  auto samples = with_model(options);
  if (!samples) return failed(samples.error());
  auto more = without_model(options);
  if (!more) return failed(more.error());
  auto clean = clean_without_model(options);
  if (!clean) return failed(clean.error());
  auto drawn = drawn_without_model(options);
  if (!drawn) return failed(drawn.error());
  const bool seen = !options.field.empty();
  if (seen) {
    for (Samples* of : {&*samples, &*more, &*clean, &*drawn}) keep_seen(*of);
  }
  Samples all = *samples;
  all.insert(all.end(), more->begin(), more->end());
  Samples also = *clean;
  also.insert(also.end(), drawn->begin(), drawn->end());
  auto weights = lab::fit_gate(all, also, options.keep_choice ? &*kept : nullptr);
  if (options.keep_draws) {
    weights.draw = kept->draw;
    weights.draw_margin = kept->draw_margin;
  }
  const auto info = flowdlo::inspect_weights(options.weights);
  const std::string notes = fmt::format(
      "{}{} on {} scenes of {} {} from {}, and without a model {}, {} of thesis and {} drawn; "
      "weights {}...",
      options.keep_choice ? "choice kept; confidence and sigma_m fitted" : "fitted",
      options.keep_draws ? ", weights of draws kept," : "", samples->size(), options.split,
      options.part, options.first, more->size(), clean->size(), drawn->size(),
      info ? info->sha256.substr(0, 16) : "unknown");
  const auto written = write_fitted(options, flowdlo::gate::calibration_of(weights, notes));
  if (!written) return failed(written.error());
  fmt::print(stderr, "{}",
             lab::report(
                 *samples, [&](auto) -> const auto& { return weights; }));
  return 0;
}

int report(const Options& options) {
  const auto model = open_model(options, false);
  if (!model) return failed(model.error());
  if (!model->fitted) return failed(no_calibration(options.weights));
  const auto samples = with_model(options);
  if (!samples) return failed(samples.error());
  fmt::print("{}", lab::report(
                       *samples, [&](auto of) -> const auto& { return model->fitted->of(of); }));
  return 0;
}

void add_options(CLI::App& command, Options& options) {
  command.add_option("--weights", options.weights, "Weights of the model, .fdw")
      ->required()
      ->check(CLI::ExistingFile);
  command.add_option("--field", options.field, "Weights of a strand field, .safetensors")
      ->check(CLI::ExistingFile);
  command
      .add_option("--cache", options.cache,
                  "Keep what was measured in NAME.jsonl, NAME_priors.jsonl, NAME_thesis.jsonl and "
                  "NAME_drawn.jsonl; remove them when path or prior change")
      ->type_name("NAME");
  command.add_option("--split", options.split, "wide or thesis")
      ->check(CLI::IsMember({"wide", "thesis"}))
      ->capture_default_str();
  command.add_option("--scenes", options.scenes, "How many")
      ->check(CLI::Range(kLeastScenes, 1000000))
      ->capture_default_str();
  command.add_option("--first", options.first, "Index of the first")->capture_default_str();
  command.add_option("--threads", options.threads, "Of the CPU back end; 0: one a core")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command.add_option("--draws", options.draws, "As the estimator is used")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command.add_option("--steps", options.steps, "Euler steps")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command.add_flag("--unrefined", options.unrefined,
                   "Leave nodes where the prior has them, whatever the strand field's file holds");
  command.add_flag("--quiet", options.quiet, "No progress bar");
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
  reporting->part = "validation";
  reporting->first = 0;
  reporting->scenes = 300;
  auto* report_command =
      support::add_command(app, "report", "What the gate of the weights is worth");
  add_options(*report_command, *reporting);
  report_command->add_option("--part", reporting->part, "training or validation")
      ->check(CLI::IsMember({"training", "validation"}))
      ->capture_default_str();
  support::set_action(*report_command, exit_code, [reporting] { return ::report(*reporting); });
}

}  // namespace flowdlo::lab
