// flowdlo-lab mask-report: what estimates are worth where the mask is rough, in one table: rendered
// scenes, each with its mask as the synthetic segmenter gives it and then made worse.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "command/report_commands.hpp"
#include "command/wide_scenes.hpp"
#include "command_line.hpp"
#include "eval/metrics.hpp"
#include "flowdlo/estimator.hpp"
#include "geometry/quantile.hpp"
#include "mask_report/rough_mask.hpp"
#include "synth/synthetic_frame.hpp"

namespace {

namespace lab = flowdlo::lab;
namespace synth = flowdlo::synth;
using flowdlo::FrameFolder;

constexpr double kFar_m = 0.02;   // a mean error beyond this is of no use
constexpr float kTrusted = 0.5F;  // a confidence that a program would go by
constexpr float kSure = 0.9F;

struct Options {
  std::string weights;
  flowdlo::lab::WideScenes wide;
};

struct Row {
  int none = 0;
  int far = 0;
  int trusted = 0;
  int far_trusted = 0;
  int sure = 0;
  double confidence = 0;
  std::vector<float> errors_cm{};

  void add(const flowdlo::Result<flowdlo::Estimate>& estimate, const flowdlo::Centerline& truth) {
    if (!estimate) {
      ++none;
      return;
    }
    const double error_m = flowdlo::eval::score(estimate->nodes, truth).either_index_m;
    errors_cm.push_back(static_cast<float>(100 * error_m));
    const bool is_far = error_m > kFar_m;
    const bool is_trusted = estimate->confidence >= kTrusted;
    far += is_far ? 1 : 0;
    trusted += is_trusted ? 1 : 0;
    far_trusted += is_far && is_trusted ? 1 : 0;
    sure += estimate->confidence >= kSure ? 1 : 0;
    confidence += static_cast<double>(estimate->confidence);
  }

  void print(const std::string& name) const {
    const auto count = static_cast<double>(std::max<std::size_t>(errors_cm.size(), 1));
    double mean_cm = 0;
    for (const float error_cm : errors_cm) mean_cm += static_cast<double>(error_cm) / count;
    auto sorted = errors_cm;
    fmt::print("| {} | {} | {:.2f} | {:.2f} | {:.0f} | {:.2f} | {} | {} | {} |\n", name, none,
               sorted.empty() ? 0.0F : flowdlo::geometry::median_of(sorted), mean_cm,
               100 * far / count, confidence / count, trusted, far_trusted, sure);
  }
};

int run(const Options& options) {
  auto estimator = flowdlo::Estimator::create({.weights = options.weights,
                                               .device = "cpu",
                                               .quality = flowdlo::Quality::kFast,
                                               .threads = 1});
  if (!estimator) {
    fmt::print(stderr, "{}\n", estimator.error().message);
    return 1;
  }
  const auto kinds = lab::roughnesses();
  std::vector<Row> rows(kinds.size());
  for (std::uint64_t i = 0; i < options.wide.scenes; ++i) {
    const std::uint64_t index = options.wide.first + i;
    const auto made = synth::make_frame(synth::Split::kWide, *synth::part_of(options.wide.part), 0,
                                        index, {.color = true});
    if (!made) {
      fmt::print(stderr, "{}\n", made.error().message);
      return 1;
    }
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      const FrameFolder rough = kinds[kind].apply(made->folder, made->meta.width_px, index);
      rows[kind].add(estimator->estimate(rough.frame()), made->truth());
    }
    fmt::print(stderr, "\r{} of {} scenes", i + 1, options.wide.scenes);
  }
  fmt::print(stderr, "\n");
  fmt::print(
      "| mask | no estimate | median error, cm | mean error, cm | over 2 cm, % | mean confidence | "
      "confidence 0.5 and more | of these over 2 cm | confidence 0.9 and more |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) rows[kind].print(kinds[kind].name);
  return 0;
}

}  // namespace

namespace flowdlo::lab {

void add_mask_report(CLI::App& program, support::ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  auto& app = *support::add_command(program, "mask-report", "How rough a mask may be");
  app.add_option("--weights", options->weights, "Weights of the model, .fdw [those that ship]")
      ->check(CLI::ExistingFile);
  add_options(app, options->wide);
  support::set_action(app, exit_code, [options] { return ::run(*options); });
}

}  // namespace flowdlo::lab
