// flowdlo_gate_fit fit: fits the calibrated gate to a model on synthetic training frames and writes
// engine/gate/fitted_weights.cpp. flowdlo_gate_fit report: what the gate is worth on frames that it
// was not fitted on.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "estimator/device_choice.hpp"
#include "flowdlo/weights.hpp"
#include "gate_fit/constants.hpp"
#include "gate_fit/fit.hpp"
#include "gate_fit/report.hpp"
#include "gate_fit/sample.hpp"
#include "gate_fit/sample_file.hpp"
#include "progress_bar.hpp"
#include "weights/weights.hpp"

namespace {

namespace lab = flowdlo::lab;
namespace synth = flowdlo::synth;
using flowdlo::Error;
using flowdlo::Result;
using Samples = std::vector<lab::GateSample>;

constexpr std::uint64_t kFirstUntrained = 1000000;  // training takes its scenes from the front
constexpr int kLeastScenes = 50;
constexpr int kLengthKnownEvery = 4;
constexpr int kPixels = 1280 * 720;

struct Options {
  std::string weights;
  std::string cache;
  std::string constants;
  std::string split = "wide";
  std::string part = "training";
  int scenes = 1000;
  std::uint64_t first = kFirstUntrained;
  int threads = 1;
  int draws = 4;
  int steps = 10;
  bool quiet = false;
};

/// Every so many training frames come with the rope's length, so that the fit learns what it is
/// worth.
double known_length_m(const Options& options, int scene, double length_m) {
  return options.part == "training" && scene % kLengthKnownEvery == 0 ? length_m : 0;
}

Result<Samples> measured(const Options& options, int done) {
  auto loaded = flowdlo::weights::load(options.weights);
  if (!loaded) return loaded.error();
  const auto weights = std::make_shared<const flowdlo::weights::Weights>(*std::move(loaded));
  const auto back_end = flowdlo::estimator::cpu_back_end(options.threads);
  auto sampler = flowdlo::flow::Sampler::create(
      weights, back_end.make_program,
      {.draws = options.draws,
       .steps = options.steps,
       .capacity = {
           .cloud_points = kPixels / 4, .field_texels = kPixels / 4, .image_pixels = kPixels}});
  if (!sampler) return sampler.error();
  Samples samples;
  flowdlo::tools::ProgressBar bar("scenes", options.scenes - done, options.quiet);
  for (int i = done; i < options.scenes; ++i) {
    const auto scene = synth::make_frame(
        *synth::split_of(options.split), *synth::part_of(options.part), /*seed=*/0,
        options.first + static_cast<std::uint64_t>(i), {.color = false});
    if (!scene) return scene.error();
    auto sample =
        lab::measure(*scene, *sampler, options.draws, weights->metadata.variant.prior_kind);
    if (sample) samples.push_back(*std::move(sample));
    bar.advance();
  }
  return samples;
}

/// From the cache as far as it reaches, the rest anew.
Result<Samples> samples_of(const Options& options) {
  const auto info = flowdlo::inspect_weights(options.weights);
  if (!info) return info.error();
  const lab::SampleOrigin origin{.weights_sha256 = info->sha256,
                                 .split = options.split,
                                 .part = options.part,
                                 .first = options.first,
                                 .draws = options.draws,
                                 .steps = options.steps};
  lab::SampleFile file;
  if (!options.cache.empty()) {
    auto read = lab::read_samples(options.cache, origin);
    if (!read) return read.error();
    file = *std::move(read);
  }
  if (file.scenes < options.scenes) {
    auto more = measured(options, file.scenes);
    if (!more) return more.error();
    file.samples.insert(file.samples.end(), more->begin(), more->end());
    file.scenes = options.scenes;
    if (!options.cache.empty()) {
      if (auto kept = lab::write_samples(options.cache, origin, file); !kept) return kept.error();
    }
  }
  std::erase_if(file.samples, [&](const lab::GateSample& sample) {
    return sample.index >= options.first + static_cast<std::uint64_t>(options.scenes);
  });
  return std::move(file.samples);
}

int failed(const Error& error) {
  fmt::print(stderr, "{}\n", error.message);
  return 1;
}

int fit(const Options& options) {
  const auto samples = samples_of(options);
  if (!samples) return failed(samples.error());
  const auto weights = lab::fit_gate(*samples);
  const auto info = flowdlo::inspect_weights(options.weights);
  const std::string origin = fmt::format(
      "Fitted on {} scenes of {} {} from {}; model {}...", samples->size(), options.split,
      options.part, options.first, info ? info->sha256.substr(0, 16) : "unknown");
  const std::string text = lab::constants_text(weights, origin);
  if (options.constants.empty()) {
    fmt::print("{}", text);
  } else if (auto written = lab::write_text(options.constants, text); !written) {
    return failed(written.error());
  }
  fmt::print(stderr, "{}", lab::report(*samples, weights));
  return 0;
}

int report(const Options& options) {
  const auto samples = samples_of(options);
  if (!samples) return failed(samples.error());
  fmt::print("{}", lab::report(*samples, flowdlo::gate::fitted_weights()));
  return 0;
}

void add_options(CLI::App& command, Options& options) {
  command.add_option("--weights", options.weights, "Weights of the model, .fdw")
      ->required()
      ->check(CLI::ExistingFile);
  command.add_option("--cache", options.cache, "Keep what was measured in FILE")->type_name("FILE");
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
  command.add_flag("--quiet", options.quiet, "No progress bar");
}

}  // namespace

int main(int count, char** values) {
  Options fitting;
  Options reporting;
  reporting.part = "validation";
  reporting.first = 0;
  reporting.scenes = 300;
  CLI::App app{"The calibrated gate on synthetic frames with truth"};
  app.require_subcommand(1);
  auto* fit_command = app.add_subcommand("fit", "Fit to a model on training frames");
  add_options(*fit_command, fitting);
  fit_command->add_option("--constants", fitting.constants, "Write them to FILE, not to stdout")
      ->type_name("FILE");
  auto* report_command = app.add_subcommand("report", "What the compiled constants are worth");
  add_options(*report_command, reporting);
  report_command->add_option("--part", reporting.part, "training or validation")
      ->check(CLI::IsMember({"training", "validation"}))
      ->capture_default_str();
  CLI11_PARSE(app, count, values);
  return fit_command->parsed() ? fit(fitting) : report(reporting);
}
