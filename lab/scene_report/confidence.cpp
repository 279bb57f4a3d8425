// flowdlo-lab scenes fit: fits the weights of estimator/ranking.cpp and estimator/confidence.cpp on
// scenes with truth and prints them. flowdlo-lab scenes confidence: how often the best hypothesis
// is right before and after comparing it with the frame, and what its confidence says, kind by
// kind.
#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "estimator/confidence.hpp"
#include "estimator/hypotheses.hpp"
#include "pictures/scene_overlay.hpp"
#include "scene_report/choice.hpp"
#include "scene_report/sample.hpp"

namespace {

using flowdlo::lab::Candidate;
using flowdlo::lab::Choice;
using flowdlo::lab::Kind;
using flowdlo::lab::Sample;
namespace estimator = flowdlo::estimator;

constexpr double kRankingRidge = 0.05;
constexpr double kConfidenceRidge = 0.3;
// Wrong winners are rare here; frames that do not come from this maker hold more of them.
constexpr double kWrongWeight = 8;
constexpr std::ptrdiff_t kFirstAgainst = 2;  // features: one, the margin, then what is against it
constexpr std::size_t kBins = 10;

struct Judged {
  const Candidate* best;
  double lead;
  float confidence;
};

double score_of(const Candidate& candidate) {
  return estimator::rescored(candidate.path_score, candidate.evidence);
}

template <class Score>
Judged judged(const Sample& sample, const Score& score) {
  std::vector<double> scores;
  for (const Candidate& candidate : sample.candidates) scores.push_back(score(candidate));
  const auto best =
      static_cast<std::size_t>(std::max_element(scores.begin(), scores.end()) - scores.begin());
  double lead = estimator::kReach;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (i != best) lead = std::min(lead, scores[best] - scores[i]);
  }
  const Candidate& winner = sample.candidates[best];
  return {&winner, lead, estimator::confidence(winner.evidence, lead)};
}

std::vector<double> ranking_row(const Candidate& candidate) {
  std::vector<double> row{candidate.path_score};
  for (const double penalty : estimator::penalties(candidate.evidence)) row.push_back(-penalty);
  return row;
}

/// Returns the weights of the penalties, that of the path score being 1.
std::vector<double> fit_ranking(const std::vector<Sample>& samples) {
  std::vector<Choice> choices;
  for (const Sample& sample : samples) {
    Choice choice;
    bool any = false;
    for (const Candidate& candidate : sample.candidates) {
      if (candidate.right && any) continue;  // one right row a group
      if (candidate.right) choice.right = choice.rows.size();
      any = any || candidate.right;
      choice.rows.push_back(ranking_row(candidate));
    }
    if (any && choice.rows.size() > 1) choices.push_back(std::move(choice));
  }
  auto weights = flowdlo::lab::fit(choices, estimator::kPenalties + 1, kRankingRidge);
  std::printf("ranking, %zu scenes with a choice; weight of the path score %.4f\nkPenaltyWeights{",
              choices.size(), weights[0]);
  std::vector<double> relative;
  for (std::size_t i = 1; i < weights.size(); ++i) {
    relative.push_back(weights[i] / weights[0]);
    std::printf("%s%.2f", i > 1 ? ", " : "", relative.back());
  }
  std::printf("}\n");
  return relative;
}

/// Logistic regression in which no feature that speaks against a traversal raises its probability:
/// one that would is left out.
std::vector<double> fit_signed(std::vector<Choice> choices) {
  while (true) {
    auto weights = flowdlo::lab::fit(choices, estimator::kConfidenceFeatures, kConfidenceRidge);
    const auto worst = std::max_element(weights.begin() + kFirstAgainst, weights.end());
    if (*worst <= 0) return weights;
    for (Choice& choice : choices) {
      choice.rows[0][static_cast<std::size_t>(worst - weights.begin())] = 0;
    }
  }
}

void fit_confidence(const std::vector<Sample>& samples, const std::vector<double>& ranking) {
  const auto score = [&](const Candidate& candidate) {
    const auto penalty = estimator::penalties(candidate.evidence);
    return candidate.path_score -
           std::inner_product(penalty.begin(), penalty.end(), ranking.begin(), 0.0);
  };
  std::vector<Choice> choices;
  for (const Sample& sample : samples) {
    const Judged judgement = judged(sample, score);
    const auto features = estimator::confidence_features(judgement.best->evidence, judgement.lead);
    Choice choice;
    choice.rows = {{features.begin(), features.end()}, std::vector<double>(features.size(), 0)};
    choice.right = judgement.best->right ? 0 : 1;
    choice.weight = judgement.best->right ? 1 : kWrongWeight;
    choices.push_back(std::move(choice));
  }
  const auto weights = fit_signed(std::move(choices));
  std::printf("confidence, %zu scenes\nkConfidenceWeights{", samples.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    std::printf("%s%.3f", i > 0 ? ", " : "", weights[i]);
  }
  std::printf("}\n");
}

struct Tally {
  int scenes = 0;
  int right_before = 0;
  int right = 0;
  int alternative = 0;
  int wrong_doubted = 0;
  int right_trusted = 0;
  std::vector<float> confidence_right;
  std::vector<double> ms;
  std::string wrong;

  void add(const Sample& sample) {
    const Judged judgement = judged(sample, score_of);
    ++scenes;
    ms.push_back(sample.judging_ms);
    right_before += judged(sample, [](const Candidate& c) { return c.path_score; }).best->right;
    if (judgement.best->right) {
      ++right;
      right_trusted += judgement.confidence >= 0.5F ? 1 : 0;
      confidence_right.push_back(judgement.confidence);
      return;
    }
    const bool other = std::any_of(sample.candidates.begin(), sample.candidates.end(),
                                   [](const Candidate& c) { return c.right; });
    alternative += other ? 1 : 0;
    wrong_doubted += judgement.confidence < 0.5F ? 1 : 0;
    char text[48];
    std::snprintf(text, sizeof text, " %llu%s(%.2f)", static_cast<unsigned long long>(sample.seed),
                  other ? "+" : "", static_cast<double>(judgement.confidence));
    wrong += text;
  }

  void print(const std::string& name) {
    std::sort(confidence_right.begin(), confidence_right.end());
    std::sort(ms.begin(), ms.end());
    const int wrongs = scenes - right;
    const double all = std::max(1, scenes);
    std::printf(
        "| %s | %d | %.1f %% | %.1f %% | %d | %d of %d | %.1f %% | %.2f | %.1f | %.1f |%s |\n",
        name.c_str(), scenes, 100 * right_before / all, 100 * right / all, alternative,
        wrong_doubted, wrongs, 100.0 * right_trusted / std::max(1, right),
        confidence_right.empty()
            ? 0.0
            : static_cast<double>(confidence_right[confidence_right.size() / 2]),
        ms.empty() ? 0 : ms[ms.size() / 2], ms.empty() ? 0 : ms[ms.size() * 95 / 100],
        wrong.c_str());
  }
};

void print_reliability(const std::vector<Sample>& samples) {
  struct Bin {
    int scenes = 0;
    int right = 0;
    double sum = 0;
  };
  std::vector<Bin> bins(kBins);
  for (const Sample& sample : samples) {
    const Judged judgement = judged(sample, score_of);
    const double confidence = static_cast<double>(judgement.confidence);
    Bin& bin = bins[std::min(kBins - 1, static_cast<std::size_t>(confidence * kBins))];
    ++bin.scenes;
    bin.right += judgement.best->right ? 1 : 0;
    bin.sum += confidence;
  }
  std::printf("\n| confidence | scenes | right |\n|---|---|---|\n");
  for (const Bin& bin : bins) {
    if (bin.scenes == 0) continue;
    std::printf("| %.2f | %d | %.1f %% |\n", bin.sum / bin.scenes, bin.scenes,
                100.0 * bin.right / bin.scenes);
  }
}

void draw_wrong(const Sample& sample, const std::string& folder) {
  const auto kind = flowdlo::lab::kind_of(sample.kind);
  const Judged judgement = judged(sample, score_of);
  if (folder.empty() || judgement.best->right || !kind) return;  // `flowdlo eval` draws the others
  const auto scene = flowdlo::lab::make_scene(*kind, sample.seed);
  const std::string file = folder + "/" + sample.kind + "_" + std::to_string(sample.seed) + ".png";
  auto truth = scene.truth;
  if (!flowdlo::prior::is_canonical(truth)) std::reverse(truth.begin(), truth.end());
  if (!flowdlo::pictures::save_overlay(file, scene, truth, judgement.best->refined)) {
    std::fprintf(stderr, "%s: cannot be written\n", file.c_str());
  }
}

void print_report(const std::vector<Sample>& samples, const std::string& folder) {
  std::printf(
      "| kind | scenes | right before | right | of the wrong: another is right |"
      " confidence < 0.5 | right with >= 0.5 | median of the right | ms p50 | ms p95 |"
      " wrong seeds |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  std::map<std::string, Tally> kinds;
  Tally all;
  for (const Sample& sample : samples) {
    kinds[sample.kind].add(sample);
    all.add(sample);
    draw_wrong(sample, folder);
  }
  for (auto& [kind, tally] : kinds) tally.print(kind);
  all.wrong.clear();
  all.print("all");
  print_reliability(samples);
}

struct Options {
  int scenes = 60;
  std::uint64_t first = 0;
  int wide = 0;
  std::uint64_t wide_first = 5000000;
  std::string overlays;
};

std::vector<Sample> make_samples(const Options& options) {
  std::vector<Sample> samples;
  for (int k = 0; k < flowdlo::lab::kKinds; ++k) {
    for (int i = 0; i < options.scenes; ++i) {
      const std::uint64_t seed = options.first + static_cast<std::uint64_t>(i);
      auto sample = measure(flowdlo::lab::make_scene(static_cast<Kind>(k), seed), seed);
      if (sample) samples.push_back(*std::move(sample));
    }
  }
  for (int i = 0; i < options.wide; ++i) {
    const auto scene = flowdlo::synth::make_frame(
        flowdlo::synth::Split::kWide, flowdlo::synth::Part::kTraining, 0,
        options.wide_first + static_cast<std::uint64_t>(i), {.color = false});
    if (!scene) continue;
    auto sample = flowdlo::lab::measure(*scene);
    if (sample) samples.push_back(*std::move(sample));
  }
  return samples;
}

}  // namespace

namespace flowdlo::lab {

void add_confidence(CLI::App& scenes) {
  auto options = std::make_shared<Options>();
  auto* fit =
      support::add_command(scenes, "fit", "Fit the estimator's ranking and confidence; print them");
  auto* report =
      support::add_command(scenes, "confidence", "What ranking and confidence are worth");
  for (CLI::App* command : {fit, report}) {
    command->add_option("--scenes", options->scenes, "Drawn scenes of each kind")
        ->capture_default_str();
    command->add_option("--first", options->first, "Seed of the first")->capture_default_str();
    command->add_option("--wide", options->wide, "Synthetic frames of the wide training split")
        ->capture_default_str();
    command->add_option("--wide-first", options->wide_first, "Index of the first")
        ->capture_default_str();
  }
  report->add_option("--overlays", options->overlays, "Draw wrong winners of drawn scenes into DIR")
      ->check(CLI::ExistingDirectory)
      ->type_name("DIR");
  fit->callback([options] {
    const std::vector<Sample> samples = make_samples(*options);
    fit_confidence(samples, fit_ranking(samples));
  });
  report->callback([options] { print_report(make_samples(*options), options->overlays); });
}

}  // namespace flowdlo::lab
