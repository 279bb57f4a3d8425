#include "eval/evaluator.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "flowdlo/frame_folder.hpp"

namespace flowdlo::eval {
namespace {

Centerline centerline(std::span<const float> values) {
  Centerline nodes{};
  for (std::size_t i = 0; i < kNodes; ++i) {
    nodes[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  }
  return nodes;
}

Config prior_config(const Config& config, PriorChoice prior) {
  Config quick = config;
  quick.prior = prior;
  quick.quality = Quality::kFull;
  quick.draws = 1;  // its prediction is not looked at
  quick.euler_steps = 1;
  return quick;
}

void add_prior(Estimator& estimator, const Frame& frame, const Centerline& truth,
               const char* method, Trial& trial) {
  Tensors tensors;
  if (!estimator.estimate(frame, tensors)) return;
  trial.methods[method] = mean_of({score(centerline(tensors.prior), truth)});
}

/// `truth` turned to the estimate's direction.
SigmaCoverage coverage_of(const Estimate& estimate, const Centerline& truth) {
  SigmaCoverage coverage;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const Point3& a = estimate.nodes[i];
    const Point3& b = truth[i];
    const float off = std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
    coverage.one += off <= estimate.sigma_m[i] ? 1.0 / kNodes : 0;
    coverage.two += off <= 2 * estimate.sigma_m[i] ? 1.0 / kNodes : 0;
  }
  return coverage;
}

void add_scores(const Estimate& estimate, const Tensors& tensors, const Centerline& truth,
                Trial& trial) {
  const Score returned = score(estimate.nodes, truth);
  trial.methods["estimate"] = mean_of({returned});
  trial.truth = turned(truth, returned);
  trial.sigma = coverage_of(estimate, trial.truth);
  std::vector<Score> draws;
  Score best = score(centerline(tensors.prior), truth);
  const std::span<const float> predictions(tensors.prediction);
  for (int d = 0; d < tensors.draws; ++d) {
    const std::size_t size = 3 * kNodes;
    draws.push_back(
        score(centerline(predictions.subspan(static_cast<std::size_t>(d) * size, size)), truth));
    if (draws.back().index_m < best.index_m) best = draws.back();
  }
  trial.methods["model"] = mean_of(draws);
  trial.methods["oracle"] = mean_of({best});
}

}  // namespace

Result<Evaluator> Evaluator::create(const Config& config) {
  auto estimator = Estimator::create(config);
  if (!estimator) return estimator.error();
  auto thesis = Estimator::create(prior_config(config, PriorChoice::kThesis));
  if (!thesis) return thesis.error();
  auto refined = Estimator::create(prior_config(config, PriorChoice::kRefined));
  if (!refined) return refined.error();
  return Evaluator(*std::move(estimator), *std::move(thesis), *std::move(refined));
}

Trial Evaluator::run(const std::filesystem::path& path, const std::string& name) {
  Trial trial;
  trial.name = name;
  const auto folder = load_frame_folder(path);
  auto scene = read_scene_info(path);
  if (scene) trial.scene = *std::move(scene);
  if (!folder || !scene) {
    trial.failure = folder ? scene.error().message : folder.error().message;
    return trial;
  }
  Tensors tensors;
  const auto estimate = estimator_.estimate(folder->frame(), tensors);
  trial.with_truth = folder->truth.has_value();
  if (!estimate) {
    trial.failure = estimate.error().message;
    return trial;
  }
  trial.nodes = estimate->nodes;
  trial.source = estimate->source;
  trial.draws = static_cast<int>(estimate->draws.size());
  for (const DrawReport& draw : estimate->draws) trial.accepted_draws += draw.accepted ? 1 : 0;
  trial.confidence = static_cast<double>(estimate->confidence);
  trial.mask_agreement = static_cast<double>(estimate->mask_agreement);
  trial.total_ms = estimate->timings.total_ms;
  if (!folder->truth) return trial;
  add_scores(*estimate, tensors, *folder->truth, trial);
  add_prior(thesis_, folder->frame(), *folder->truth, "prior", trial);
  add_prior(refined_, folder->frame(), *folder->truth, "refined", trial);
  return trial;
}

Evaluator::Evaluator(Estimator estimator, Estimator thesis, Estimator refined)
    : estimator_(std::move(estimator)), thesis_(std::move(thesis)), refined_(std::move(refined)) {}

}  // namespace flowdlo::eval
