#include "scene_report/outcome.hpp"

#include <algorithm>
#include <chrono>

#include "estimator/confidence.hpp"
#include "estimator/hypotheses.hpp"
#include "evidence/visible_points.hpp"
#include "geometry/camera.hpp"
#include "path/path.hpp"
#include "prior_report/traversal.hpp"

namespace flowdlo::lab {
namespace {

double index_error_cm(const Centerline& nodes, const Centerline& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    sum += (geometry::to_eigen(nodes[i]) - geometry::to_eigen(truth[i])).norm();
  }
  return 100 * sum / kNodes;  // Eq. (4.1)
}

Centerline reversed(Centerline nodes) {
  std::reverse(nodes.begin(), nodes.end());
  return nodes;
}

Centerline turned(const Centerline& truth, const Centerline& nodes) {
  const Centerline back = reversed(truth);
  return index_error_cm(nodes, back) < index_error_cm(nodes, truth) ? back : truth;
}

template <class Work>
auto timed(double& ms, const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  auto result = work();
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  ms = took.count();
  return result;
}

}  // namespace

Outcome outcome_of(const Scene& scene, std::uint64_t seed) {
  Outcome outcome;
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
  outcome.truth = turned(scene.truth, best.prior.nodes);
  outcome.flipped = !prior::is_canonical(outcome.truth);
  outcome.index_cm = index_error_cm(best.prior.nodes, outcome.truth);
  if (const auto thesis = prior::lift(path, visible, frame)) {
    outcome.thesis_cm = index_error_cm(thesis->nodes, turned(scene.truth, thesis->nodes));
  }
  outcome.confidence = estimator::confidence(best.evidence, estimator::lead(*lifted));
  return outcome;
}

}  // namespace flowdlo::lab
