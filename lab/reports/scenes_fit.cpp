// flowdlo-lab scenes fit: fits the weights of estimator/ranking.cpp and estimator/confidence.cpp on
// drawn and rendered scenes with truth, and prints them.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "command/report_commands.hpp"
#include "command_line.hpp"
#include "estimator/conditions.hpp"
#include "estimator/confidence.hpp"
#include "estimator/hypotheses.hpp"
#include "eval/metrics.hpp"
#include "survey/choice_fit.hpp"
#include "synth/drawn_frame.hpp"

namespace flowdlo::lab {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kRankingRidge = 0.05;
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

struct Candidate {
  estimator::Evidence evidence;
  double path_score = 0;
  bool right = false;  ///< no node is astray along the rope, in the better direction
};
using Sample = std::vector<Candidate>;  // in the order of path::trace; never empty

/// Nothing where no path was found or the first could not be lifted.
void measure(const synth::SyntheticFrame& scene, std::vector<Sample>& samples) {
  Timings timings;
  const auto conditions = estimator::gather(scene.frame(), {}, timings);
  if (!conditions) return;
  Sample sample;
  for (const auto& hypothesis : conditions->hypotheses) {
    const eval::Score score = eval::score(hypothesis.prior.nodes, scene.truth());
    sample.push_back(
        {hypothesis.evidence, hypothesis.path_score,
         score.strand_errors <= 0 && score.either_index_m < kMostErrorShare * scene.meta.length_m});
  }
  samples.push_back(std::move(sample));
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

/// The path's score, and what each penalty takes from it.
VectorXd ranking_row(const Candidate& candidate) {
  const auto penalties = estimator::penalties(candidate.evidence);
  VectorXd row(static_cast<Index>(penalties.size()) + 1);
  row[0] = candidate.path_score;
  for (std::size_t i = 0; i < penalties.size(); ++i) row[static_cast<Index>(i) + 1] = -penalties[i];
  return row;
}

std::string listed(const VectorXd& weights, int digits) {
  std::string text;
  for (const double weight : weights) {
    text += fmt::format("{}{:.{}f}", text.empty() ? "" : ", ", weight, digits);
  }
  return text;
}

/// Returns the weights of ranking_row, that of the path score being 1.
VectorXd fit_ranking(const std::vector<Sample>& samples) {
  constexpr auto kFeatures = static_cast<Index>(estimator::kPenalties) + 1;
  std::vector<survey::Choice> choices;
  for (const Sample& sample : samples) {
    std::vector<VectorXd> rows;
    Index right = -1;
    for (const Candidate& candidate : sample) {
      if (candidate.right && right >= 0) continue;  // one right row a group
      if (candidate.right) right = static_cast<Index>(rows.size());
      rows.push_back(ranking_row(candidate));
    }
    if (right < 0 || rows.size() < 2) continue;
    survey::Choice choice{Eigen::MatrixXd(static_cast<Index>(rows.size()), kFeatures), right};
    for (std::size_t i = 0; i < rows.size(); ++i) {
      choice.rows.row(static_cast<Index>(i)) = rows[i].transpose();
    }
    choices.push_back(std::move(choice));
  }
  VectorXd weights = survey::fit(choices, kFeatures, kRankingRidge);
  fmt::print("ranking, {} scenes with a choice; weight of the path score {:.4f}\n", choices.size(),
             weights[0]);
  weights /= weights[0];
  fmt::print("kPenaltyWeights{{{}}}\n", listed(weights.tail(kFeatures - 1), 2));
  return weights;
}

/// Whether the best of a sample is right, by what is known of it.
survey::Choice confidence_choice(const Sample& sample, const VectorXd& ranking) {
  std::vector<double> scores;
  for (const Candidate& candidate : sample) scores.push_back(ranking_row(candidate).dot(ranking));
  const auto best = std::max_element(scores.begin(), scores.end());
  double lead = estimator::kReach;
  for (auto other = scores.begin(); other != scores.end(); ++other) {
    if (other != best) lead = std::min(lead, *best - *other);
  }
  const Candidate& winner = sample[static_cast<std::size_t>(best - scores.begin())];
  const auto features = estimator::confidence_features(winner.evidence, lead);
  survey::Choice choice{Eigen::MatrixXd::Zero(2, static_cast<Index>(features.size())),
                        winner.right ? 0 : 1, winner.right ? 1 : kWrongWeight};
  for (std::size_t i = 0; i < features.size(); ++i) {
    choice.rows(0, static_cast<Index>(i)) = features[i];
  }
  return choice;
}

/// Logistic regression in which no feature that speaks against a traversal raises its probability:
/// one that would is left out.
void fit_confidence(const std::vector<Sample>& samples, const VectorXd& ranking) {
  constexpr auto kFeatures = static_cast<Index>(estimator::kConfidenceFeatures);
  std::vector<survey::Choice> choices;
  for (const Sample& sample : samples) choices.push_back(confidence_choice(sample, ranking));
  std::vector<bool> fixed(kFeatures);
  VectorXd weights;
  while (true) {
    weights = survey::fit(choices, kFeatures, kConfidenceRidge, fixed);
    Index worst = 0;
    if (weights.tail(kFeatures - kFirstAgainst).maxCoeff(&worst) <= 0) break;
    fixed[static_cast<std::size_t>(kFirstAgainst + worst)] = true;
  }
  fmt::print("confidence, {} scenes\nkConfidenceWeights{{{}}}\n", samples.size(),
             listed(weights, 3));
}

}  // namespace

void add_scenes(CLI::App& program, support::ExitCode& exit_code) {
  auto& scenes = *support::add_command(program, "scenes",
                                       "Ranking and confidence of hypotheses, before any model");
  scenes.require_subcommand(1);
  auto options = std::make_shared<Options>();
  auto& app = *support::add_command(scenes, "fit",
                                    "Fit the estimator's ranking and confidence; print them");
  app.add_option("--scenes", options->scenes, "Drawn scenes of each kind")->capture_default_str();
  app.add_option("--first", options->first, "Seed of the first")->capture_default_str();
  app.add_option("--wide", options->wide, "Synthetic frames of the wide training split")
      ->capture_default_str();
  app.add_option("--wide-first", options->wide_first, "Index of the first")->capture_default_str();
  support::set_action(app, exit_code, [options] {
    const std::vector<Sample> samples = make_samples(*options);
    if (samples.empty()) return 1;
    fit_confidence(samples, fit_ranking(samples));
    return 0;
  });
}

}  // namespace flowdlo::lab
