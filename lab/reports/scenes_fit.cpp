// flowdlo-lab scenes fit: fits the weights of estimator/confidence.cpp on drawn and rendered scenes
// with truth, and prints them.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <memory>
#include <string>
#include <vector>

#include "command/report_commands.hpp"
#include "command_line.hpp"
#include "estimator/candidates.hpp"
#include "estimator/conditions.hpp"
#include "estimator/confidence.hpp"
#include "estimator/hypotheses.hpp"
#include "estimator/second_look.hpp"
#include "eval/metrics.hpp"
#include "survey/choice_fit.hpp"
#include "synth/drawn_frame.hpp"

namespace flowdlo::lab {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kConfidenceRidge = 0.3;
// Wrong winners are rare here; frames that do not come from this maker hold more of them.
constexpr double kWrongWeight = 8;
constexpr Index kFirstAgainst = 2;        // features: one, the margin, then what is against it
constexpr double kMostErrorShare = 0.05;  // of the rope's length, of what is right

struct Options {
  std::uint64_t scenes = 60;
  std::uint64_t first = 0;
  std::uint64_t wide = 0;
  std::uint64_t wide_first = 5000000;
};

/// The best hypothesis of a frame.
struct Sample {
  gate::Candidate winner;
  double lead = 0;
  bool right = false;  ///< no node is astray along the rope, in the better direction
};

/// Nothing where no path was found or the first could not be lifted.
void measure(const synth::SyntheticFrame& scene, std::vector<Sample>& samples) {
  Timings timings;
  const Frame frame = scene.frame();
  const auto conditions = estimator::gather(frame, {}, timings);
  if (!conditions) return;
  const auto look = estimator::first_look(*conditions, frame);
  const auto priors =
      estimator::list_candidates(look, conditions->paths.rope_width_px, {}, {}, {}, frame, 0);
  const eval::Score score = eval::score(priors.front().nodes, scene.truth());
  samples.push_back(
      {priors.front(), estimator::lead(look.hypotheses),
       score.strand_errors <= 0 && score.either_index_m < kMostErrorShare * scene.meta.length_m});
}

std::vector<Sample> make_samples(const Options& options) {
  std::vector<Sample> samples;
  for (int k = 0; k < kKinds; ++k) {
    for (std::uint64_t i = 0; i < options.scenes; ++i) {
      measure(synth::drawn_frame(static_cast<Kind>(k), options.first + i), samples);
    }
  }
  for (std::uint64_t i = 0; i < options.wide; ++i) {
    const auto scene = synth::make_frame(synth::Split::kWide, synth::Part::kTraining, 0,
                                         options.wide_first + i, {.color = false});
    if (scene) measure(*scene, samples);
  }
  return samples;
}

std::string listed(const VectorXd& weights) {
  std::string text;
  for (const double weight : weights) {
    text += fmt::format("{}{:.3f}", text.empty() ? "" : ", ", weight);
  }
  return text;
}

/// Whether the best hypothesis is right, by what is known of it.
survey::Choice choice_of(const Sample& sample) {
  const auto features = estimator::confidence_features(sample.winner, sample.lead);
  survey::Choice choice{Eigen::MatrixXd::Zero(2, static_cast<Index>(features.size())),
                        sample.right ? 0 : 1, sample.right ? 1 : kWrongWeight};
  for (std::size_t i = 0; i < features.size(); ++i) {
    choice.rows(0, static_cast<Index>(i)) = features[i];
  }
  return choice;
}

/// Logistic regression in which no feature that speaks against a traversal raises its probability:
/// one that would is left out.
void fit_confidence(const std::vector<Sample>& samples) {
  constexpr auto kFeatures = static_cast<Index>(estimator::kConfidenceFeatures);
  std::vector<survey::Choice> choices;
  for (const Sample& sample : samples) choices.push_back(choice_of(sample));
  std::vector<bool> fixed(kFeatures);
  VectorXd weights;
  while (true) {
    weights = survey::fit(choices, kFeatures, kConfidenceRidge, fixed);
    Index worst = 0;
    if (weights.tail(kFeatures - kFirstAgainst).maxCoeff(&worst) <= 0) break;
    fixed[static_cast<std::size_t>(kFirstAgainst + worst)] = true;
  }
  fmt::print("confidence, {} scenes\nkConfidenceWeights{{{}}}\n", samples.size(), listed(weights));
}

}  // namespace

void add_scenes(CLI::App& program, support::ExitCode& exit_code) {
  auto& scenes =
      *support::add_command(program, "scenes", "Confidence of hypotheses, before any model");
  scenes.require_subcommand(1);
  auto options = std::make_shared<Options>();
  auto& app = *support::add_command(
      scenes, "fit", "Fit the confidence of a model without a calibrated gate; print it");
  app.add_option("--scenes", options->scenes, "Drawn scenes of each kind")->capture_default_str();
  app.add_option("--first", options->first, "Seed of the first")->capture_default_str();
  app.add_option("--wide", options->wide, "Synthetic frames of the wide training split")
      ->capture_default_str();
  app.add_option("--wide-first", options->wide_first, "Index of the first")->capture_default_str();
  support::set_action(app, exit_code, [options] {
    const std::vector<Sample> samples = make_samples(*options);
    if (samples.empty()) return 1;
    fit_confidence(samples);
    return 0;
  });
}

}  // namespace flowdlo::lab
