#include "scene_report/sample.hpp"

#include <algorithm>
#include <chrono>

#include "estimator/hypotheses.hpp"
#include "eval/metrics.hpp"
#include "evidence/visible_points.hpp"
#include "path/path.hpp"
#include "scene_report/traversal.hpp"

namespace flowdlo::lab {
namespace {

using Eigen::Vector2f;

// How much of a path's end may lie elsewhere: a tip that is hidden, or that runs along another
// strand, does not make the order wrong.
constexpr float kTipWidths = 6;
constexpr float kTipShare = 0.08F;        // and no more than that of the path
constexpr double kMostErrorShare = 0.05;  // of the rope's length

using Points = std::vector<Vector2f>;

/// Index of the first point at least `length_px` along the points.
std::size_t at_length(const Points& points, float length_px) {
  float sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    sum += (points[i] - points[i - 1]).norm();
    if (sum >= length_px) return i;
  }
  return points.size() - 1;
}

/// `points` with `tip_px` of its start replaced by the true start.
Points with_true_start(const Points& points, const Points& truth, float tip_px) {
  const std::size_t cut = at_length(points, tip_px);
  const std::size_t last = at_length(truth, 3 * tip_px);
  std::size_t nearest = 0;
  for (std::size_t i = 0; i <= last; ++i) {
    if ((truth[i] - points[cut]).norm() < (truth[nearest] - points[cut]).norm()) nearest = i;
  }
  Points result(truth.begin(), truth.begin() + static_cast<std::ptrdiff_t>(nearest) + 1);
  result.insert(result.end(), points.begin() + static_cast<std::ptrdiff_t>(cut), points.end());
  return result;
}

Points reversed(Points points) {
  std::reverse(points.begin(), points.end());
  return points;
}

bool right(const path::Path& path, float width_px, const Scene& scene) {
  if (follows_rope(path, scene)) return true;
  float length_px = 0;
  for (std::size_t i = 1; i < path.points_px.size(); ++i) {
    length_px += (path.points_px[i] - path.points_px[i - 1]).norm();
  }
  const float tip_px = std::min(kTipWidths * width_px, kTipShare * length_px);
  const Points truth = true_path(scene).points_px;
  for (const Points& points : {path.points_px, reversed(path.points_px)}) {
    path::Path mended;
    mended.points_px = with_true_start(points, truth, tip_px);
    mended.points_px =
        reversed(with_true_start(reversed(mended.points_px), reversed(truth), tip_px));
    mended.bridged.assign(mended.points_px.size(), 0);
    if (follows_rope(mended, scene)) return true;
  }
  return false;
}

/// `right` judges a hypothesis.
template <class Right>
std::optional<Sample> judged(const Frame& frame, Sample sample, const Right& right) {
  const auto traced = path::trace(frame);
  if (!traced) return std::nullopt;
  const auto cloud = evidence::unproject(frame);
  const auto visible = evidence::visible_points(cloud);
  const auto start = std::chrono::steady_clock::now();
  const auto lifted =
      estimator::lift_all(*traced, cloud, visible, frame, weights::PriorKind::kRefined);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  if (!lifted) return std::nullopt;
  sample.judging_ms = took.count();
  for (const auto& hypothesis : *lifted) {
    sample.candidates.push_back(
        {hypothesis.evidence, hypothesis.prior, hypothesis.path_score, right(hypothesis, *traced)});
  }
  return sample;
}

}  // namespace

std::optional<Sample> measure(const Scene& scene, std::uint64_t seed) {
  return judged(scene.frame(), {std::string(name_of(scene.kind)), seed, {}, 0},
                [&](const estimator::Hypothesis& hypothesis, const path::Traversals& traced) {
                  return right(traced.ranked[hypothesis.path], traced.rope_width_px, scene);
                });
}

std::optional<Sample> measure(const synth::SyntheticFrame& scene) {
  return judged(scene.frame(), {scene.meta.scenario, scene.meta.index, {}, 0},
                [&](const estimator::Hypothesis& hypothesis, const path::Traversals&) {
                  const eval::Score score = eval::score(hypothesis.prior.nodes, scene.truth());
                  return score.strand_errors <= 0 &&
                         score.either_index_m < kMostErrorShare * scene.meta.length_m;
                });
}

}  // namespace flowdlo::lab
