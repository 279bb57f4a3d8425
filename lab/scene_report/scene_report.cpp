// flowdlo-lab scenes report: path, refined prior and confidence against the truth, kind by kind, as
// one Markdown table; --overlays draws the worst scenes of all kinds.
#include <CLI/App.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "command/report_commands.hpp"
#include "command_line.hpp"
#include "pictures/scene_overlay.hpp"
#include "scene_report/confidence.hpp"
#include "scene_report/outcome.hpp"

namespace {

using flowdlo::lab::Kind;
using flowdlo::lab::SceneOutcome;

struct Options {
  int scenes = 60;
  std::uint64_t first = 0;
  std::string kind;
  std::string overlays;
  int worst = 20;
};

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size()));
  return values[std::min(at, values.size() - 1)];
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

struct Tally {
  int scenes = 0;
  int answered = 0;
  int right = 0;
  int flipped = 0;
  int runner_up_right = 0;  // of the wrong
  int doubted = 0;          // of the wrong
  int trusted = 0;          // of the right
  std::vector<double> index_cm, thesis_cm, path_ms, prior_ms;

  void add(const SceneOutcome& outcome) {
    ++scenes;
    path_ms.push_back(outcome.path_ms);
    if (!outcome.answered) return;
    ++answered;
    prior_ms.push_back(outcome.prior_ms);
    index_cm.push_back(outcome.index_cm);
    thesis_cm.push_back(outcome.thesis_cm);
    flipped += outcome.flipped ? 1 : 0;
    if (outcome.right) {
      ++right;
      trusted += outcome.confidence >= 0.5F ? 1 : 0;
    } else {
      runner_up_right += outcome.runner_up_right ? 1 : 0;
      doubted += outcome.confidence < 0.5F ? 1 : 0;
    }
  }

  void print(const std::string& name) const {
    const int wrong = answered - right;
    std::printf(
        "| %s | %d | %d | %.1f %% | %.3f / %.3f / %.3f | %.2f | %d | %d of %d | %d of %d | "
        "%.1f %% | %.1f / %.1f | %.1f / %.1f |\n",
        name.c_str(), scenes, answered, 100.0 * right / std::max(1, scenes), mean(index_cm),
        percentile(index_cm, 0.5), percentile(index_cm, 0.95), mean(thesis_cm), flipped,
        runner_up_right, wrong, doubted, wrong, 100.0 * trusted / std::max(1, right),
        percentile(path_ms, 0.5), percentile(path_ms, 0.95), percentile(prior_ms, 0.5),
        percentile(prior_ms, 0.95));
    std::fflush(stdout);
  }
};

// Prints the worst to stderr and draws them where a folder is given.
bool show_worst(std::vector<SceneOutcome> outcomes, const Options& options) {
  std::sort(outcomes.begin(), outcomes.end(),
            [](const SceneOutcome& a, const SceneOutcome& b) { return a.index_cm > b.index_cm; });
  outcomes.resize(std::min(outcomes.size(), static_cast<std::size_t>(options.worst)));
  bool drawn = true;
  for (const SceneOutcome& bad : outcomes) {
    const std::string name = std::string(name_of(bad.kind)) + "_" + std::to_string(bad.seed);
    std::fprintf(stderr, "  %s: %.3f cm, %s, confidence %.2f\n", name.c_str(), bad.index_cm,
                 bad.right ? "right" : "wrong", static_cast<double>(bad.confidence));
    if (options.overlays.empty()) continue;
    const auto scene = flowdlo::lab::make_scene(bad.kind, bad.seed);
    const std::string file = options.overlays + "/" + name + ".png";
    if (flowdlo::pictures::save_overlay(file, scene, bad.truth, bad.prior)) continue;
    std::fprintf(stderr, "%s: cannot be written; name an existing folder\n", file.c_str());
    drawn = false;
  }
  return drawn;
}

int report(const Options& options) {
  std::printf(
      "index error in cm: mean / median / 95 %%; times in ms: median / 95 %%\n"
      "| kind | scenes | answered | right | refined prior | thesis prior, mean | flips |"
      " runner-up right, of the wrong | confidence < 0.5, of the wrong |"
      " confidence >= 0.5, of the right | path | priors |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  std::vector<SceneOutcome> all;
  Tally total;
  for (int k = 0; k < flowdlo::lab::kKinds; ++k) {
    const auto kind = static_cast<Kind>(k);
    if (!options.kind.empty() && name_of(kind) != options.kind) continue;
    Tally tally;
    for (int i = 0; i < options.scenes; ++i) {
      const std::uint64_t seed = options.first + static_cast<std::uint64_t>(i);
      const SceneOutcome outcome = outcome_of(flowdlo::lab::make_scene(kind, seed), seed);
      tally.add(outcome);
      total.add(outcome);
      if (outcome.answered) all.push_back(outcome);
    }
    tally.print(std::string(name_of(kind)));
  }
  total.print("all");
  return show_worst(std::move(all), options) ? 0 : 1;
}

}  // namespace

namespace flowdlo::lab {

void add_scenes(CLI::App& program, support::ExitCode& exit_code) {
  auto& scenes = *support::add_command(
      program, "scenes", "Path, priors and confidence on scenes with truth, before any model");
  scenes.require_subcommand(1);
  auto options = std::make_shared<Options>();
  auto& app =
      *support::add_command(scenes, "report", "Path, refined prior and confidence on drawn scenes");
  app.add_option("--scenes", options->scenes, "Of each kind")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  app.add_option("--first", options->first, "Seed of the first scene of each kind")
      ->capture_default_str();
  app.add_option("--kind", options->kind, "Of this kind only")
      ->check(CLI::Validator(
          [](const std::string& name) {
            return flowdlo::lab::kind_of(name) ? std::string() : "no kind of scene: " + name;
          },
          "KIND"));
  app.add_option("--overlays", options->overlays, "Draw the worst scenes into DIR")
      ->check(CLI::ExistingDirectory)
      ->type_name("DIR");
  app.add_option("--worst", options->worst, "How many of them")
      ->capture_default_str()
      ->check(CLI::Range(0, 1000000));
  support::set_action(app, exit_code, [options] { return ::report(*options); });
  add_confidence(scenes);
}

}  // namespace flowdlo::lab
