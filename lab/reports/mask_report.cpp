// flowdlo-lab mask-report: what estimates are worth where the mask is rough, in one table: rendered
// scenes, each with its mask as the synthetic segmenter gives it and then made worse.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command/report_commands.hpp"
#include "command_line.hpp"
#include "eval/metrics.hpp"
#include "reports/rough_mask.hpp"
#include "survey/table.hpp"
#include "survey/values.hpp"
#include "survey/wide_scenes.hpp"

namespace flowdlo::lab {
namespace {

constexpr double kFar_cm = 2;     // a mean error beyond this is of no use
constexpr double kTrusted = 0.5;  // a confidence that a program would go by
constexpr double kSure = 0.9;

struct Options {
  std::string weights;
  survey::WideScenes wide;
};

/// Of one scene with its mask in one way.
struct Answer {
  double error_cm = 0;
  double confidence = 0;
};
using Answers = std::vector<std::optional<Answer>>;  // [roughnesses()]

Result<Answers> answers(const Options& options, Estimator& estimator, std::uint64_t index) {
  const auto made = options.wide.make(index);
  if (!made) return made.error();
  Answers all;
  for (const Roughness& kind : roughnesses()) {
    const FrameFolder rough = kind.apply(made->folder, made->meta.width_px, index);
    auto& answer = all.emplace_back();
    if (const auto estimate = estimator.estimate(rough.frame())) {
      const double error_m = eval::score(estimate->nodes, made->truth()).either_index_m;
      answer = {100 * error_m, static_cast<double>(estimate->confidence)};
    }
  }
  return all;
}

std::vector<std::string> row(const std::string& name, const std::vector<Answers>& scenes,
                             std::size_t kind) {
  survey::Values errors_cm;
  survey::Values confidence;
  int none = 0, trusted = 0, far_trusted = 0, sure = 0;
  for (const Answers& of : scenes) {
    const auto& answer = of[kind];
    if (!answer) {
      ++none;
      continue;
    }
    errors_cm.add(answer->error_cm);
    confidence.add(answer->confidence);
    const bool is_trusted = answer->confidence >= kTrusted;
    trusted += is_trusted ? 1 : 0;
    far_trusted += is_trusted && answer->error_cm > kFar_cm ? 1 : 0;
    sure += answer->confidence >= kSure ? 1 : 0;
  }
  return {name,
          std::to_string(none),
          fmt::format("{:.2f}", errors_cm.median()),
          fmt::format("{:.2f}", errors_cm.mean()),
          fmt::format("{:.0f}", errors_cm.percent_over(kFar_cm)),
          fmt::format("{:.2f}", confidence.mean()),
          std::to_string(trusted),
          std::to_string(far_trusted),
          std::to_string(sure)};
}

int run(const Options& options) {
  const auto scenes = survey::over<Answers>(
      options.wide, [&] { return survey::one_estimator(options.weights); },
      [&](Estimator& estimator, std::uint64_t index) {
        return answers(options, estimator, index);
      });
  if (scenes.empty()) return 1;
  survey::Table table({"mask", "no estimate", "median error, cm", "mean error, cm", "over 2 cm, %",
                       "mean confidence", "confidence 0.5 and more", "of these over 2 cm",
                       "confidence 0.9 and more"});
  const auto kinds = roughnesses();
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    table.add(row(kinds[kind].name, scenes, kind));
  }
  fmt::print("{}", table.text());
  return 0;
}

}  // namespace

void add_mask_report(CLI::App& program, support::ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  auto& app = *support::add_command(program, "mask-report", "How rough a mask may be");
  app.add_option("--weights", options->weights, "Weights of the model, .fdw [those that ship]")
      ->check(CLI::ExistingFile);
  add_options(app, options->wide);
  support::set_action(app, exit_code, [options] { return run(*options); });
}

}  // namespace flowdlo::lab
