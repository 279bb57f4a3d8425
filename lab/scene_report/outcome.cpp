#include "scene_report/outcome.hpp"

#include <algorithm>
#include <chrono>

#include "estimator/confidence.hpp"
#include "estimator/hypotheses.hpp"
#include "eval/metrics.hpp"
#include "evidence/visible_points.hpp"
#include "path/path.hpp"
#include "scene_report/traversal.hpp"

namespace flowdlo::lab {
namespace {

template <class Work>
auto timed(double& ms, const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  auto result = work();
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  ms = took.count();
  return result;
}

}  // namespace

SceneOutcome outcome_of(const Scene& scene, std::uint64_t seed) {
  SceneOutcome outcome;
  outcome.kind = scene.kind;
  outcome.seed = seed;
  const Frame frame = scene.frame();
  const auto cloud = evidence::unproject(frame);
  const auto visible = evidence::visible_points(cloud);
  const auto traced = timed(outcome.path_ms, [&] { return path::trace(frame); });
  if (!traced) return outcome;
  const auto lifted = timed(outcome.prior_ms, [&] {
    return estimator::lift_all(*traced, cloud, visible, frame, weights::PriorKind::kRefined);
  });
  if (!lifted) return outcome;

  outcome.answered = true;
  const auto& best = lifted->front();
  const path::Path& path = traced->ranked[best.path];
  outcome.right = follows_rope(path, scene);
  outcome.runner_up_right =
      std::any_of(lifted->begin() + 1, lifted->end(), [&](const estimator::Hypothesis& other) {
        return follows_rope(traced->ranked[other.path], scene);
      });
  outcome.prior = best.prior;
  const eval::Score score = eval::score(best.prior.nodes, scene.truth);
  outcome.truth = eval::turned(scene.truth, score);
  outcome.flipped = score.flipped;
  outcome.index_cm = 100 * score.either_index_m;
  if (const auto thesis = prior::lift(path, visible, frame)) {
    outcome.thesis_cm = 100 * eval::score(thesis->nodes, scene.truth).either_index_m;
  }
  outcome.confidence = estimator::confidence(best.evidence, estimator::lead(*lifted));
  return outcome;
}

}  // namespace flowdlo::lab
