#include "eval/evaluator.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "eval/draws.hpp"
#include "flowdlo/frame_folder.hpp"

namespace flowdlo::eval {
namespace {

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
  trial.methods[method] = mean_of({score(centerline_of(tensors.prior), truth)});
  trial.curves[method] = {kept(centerline_of(tensors.prior))};
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
  add_draw_scores(estimate, tensors, truth, "", trial);
}

}  // namespace

Config in_full(const Config& config, const Estimator& estimator) {
  Config full = config;
  full.quality = Quality::kFull;
  full.euler_steps = estimator.euler_steps();
  full.draws = estimator.draws();
  return full;
}

Result<Evaluator> Evaluator::create(const Config& config, const ContenderConfig& contenders) {
  auto estimator = Estimator::create(config);
  if (!estimator) return estimator.error();
  auto thesis = Estimator::create(prior_config(config, PriorChoice::kThesis));
  if (!thesis) return thesis.error();
  auto refined = Estimator::create(prior_config(config, PriorChoice::kRefined));
  if (!refined) return refined.error();
  auto others = Contenders::create(in_full(config, *estimator), contenders);
  if (!others) return others.error();
  return Evaluator(*std::move(estimator), *std::move(thesis), *std::move(refined),
                   *std::move(others));
}

Trial Evaluator::run(const std::filesystem::path& path, const std::string& name) {
  return run(load_frame_folder(path), read_scene_info(path), path, name);
}

Trial Evaluator::run(const Result<FrameFolder>& folder, const Result<SceneInfo>& scene,
                     const std::filesystem::path& path, const std::string& name) {
  Trial trial;
  trial.name = name;
  trial.folder = path;
  trial.data_set = std::filesystem::absolute(path).lexically_normal().parent_path().filename();
  if (scene) trial.scene = *scene;
  if (!folder || !scene) {
    trial.failure = folder ? scene.error().message : folder.error().message;
    return trial;
  }
  trial.with_truth = folder->truth.has_value();
  if (folder->truth) trial.truth = canonical(*folder->truth);
  run_own(*folder, trial);
  contenders_.run(*folder, trial);
  return trial;
}

void Evaluator::run_own(const FrameFolder& folder, Trial& trial) {
  Tensors tensors;
  const auto estimate = estimator_.estimate(folder.frame(), tensors);
  if (!estimate) {
    trial.failure = estimate.error().message;
    trial.accounts["estimate"].failure = name_of(estimate.error().code);
    return;
  }
  Account& account = trial.accounts["estimate"];
  account.output = true;
  account.mask_agreement = static_cast<double>(estimate->mask_agreement);
  trial.nodes = estimate->nodes;
  trial.source = estimate->source;
  trial.draws = static_cast<int>(estimate->draws.size());
  for (const DrawReport& draw : estimate->draws) trial.accepted_draws += draw.accepted ? 1 : 0;
  trial.confidence = static_cast<double>(estimate->confidence);
  trial.mask_agreement = static_cast<double>(estimate->mask_agreement);
  trial.total_ms = estimate->timings.total_ms;
  add_draws(*estimate, tensors, "", trial);
  if (!folder.truth) return;
  add_scores(*estimate, tensors, *folder.truth, trial);
  add_prior(thesis_, folder.frame(), *folder.truth, "prior", trial);
  add_prior(refined_, folder.frame(), *folder.truth, "refined", trial);
}

Evaluator::Evaluator(Estimator estimator, Estimator thesis, Estimator refined,
                     Contenders contenders)
    : estimator_(std::move(estimator)),
      thesis_(std::move(thesis)),
      refined_(std::move(refined)),
      contenders_(std::move(contenders)) {}

}  // namespace flowdlo::eval
