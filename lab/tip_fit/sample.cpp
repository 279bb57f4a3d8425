#include "tip_fit/sample.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "estimator/candidates.hpp"
#include "estimator/conditions.hpp"
#include "estimator/parted.hpp"
#include "estimator/refinement.hpp"
#include "estimator/rope_views.hpp"
#include "estimator/second_look.hpp"
#include "estimator/see_axes.hpp"
#include "eval/metrics.hpp"
#include "geometry/camera.hpp"
#include "geometry/smooth_curve.hpp"

namespace flowdlo::lab {
namespace {

constexpr double kAboutRight_m = 0.05;  // mean index error of a hypothesis that is worth asking
constexpr double kNearRadii = 3;        // between an end and the rope that it belongs to,
constexpr double kNear_m = 0.002;       // and some for noise
constexpr double kOwnHalf = 0.45;       // of a curve: what belongs to its first end
constexpr int kPoints = 600;            // of a curve that an end is looked for on

/// A curve from its first end on.
struct Line {
  std::vector<Eigen::Vector3d> points;
  double step_m = 0;

  explicit Line(const Centerline& nodes) {
    for (const Point3& point : geometry::smooth_curve(nodes, kPoints)) {
      points.push_back(geometry::to_eigen(point).cast<double>());
    }
    for (std::size_t i = 1; i < points.size(); ++i) {
      step_m += (points[i] - points[i - 1]).norm() / (kPoints - 1);
    }
  }

  /// Where on the half that belongs to the first end `p` is nearest, and how near.
  [[nodiscard]] std::pair<int, double> nearest(const Eigen::Vector3d& p) const {
    std::pair<int, double> best{0, std::numeric_limits<double>::infinity()};
    for (int i = 0; i < static_cast<int>(kOwnHalf * kPoints); ++i) {
      const double away = (points[static_cast<std::size_t>(i)] - p).norm();
      if (away < best.second) best = {i, away};
    }
    return best;
  }
};

/// Puts both ends of a hypothesis among the samples, where they are an end of `rope` and it is
/// about right.
void add_ends(const gate::Candidate& hypothesis, const Centerline& rope, std::uint64_t index,
              const Frame& frame, const field::FieldView& seen, std::vector<TipSample>& samples) {
  if (hypothesis.ring != 0 || !(hypothesis.radius_m > 0)) return;
  const eval::Score score = eval::score(hypothesis.nodes, rope);
  if (!(score.either_index_m < kAboutRight_m)) return;
  const Centerline truth = eval::turned(rope, score);
  const auto radius_m = static_cast<double>(hypothesis.radius_m);
  const double near_m = kNearRadii * radius_m + kNear_m;
  const refine::Curve curve = estimator::curve_of(hypothesis);
  for (const bool last : {false, true}) {
    const auto beyond =
        last ? beyond_m(eval::reversed(hypothesis.nodes), eval::reversed(truth), near_m)
             : beyond_m(hypothesis.nodes, truth, near_m);
    if (!beyond) continue;
    samples.push_back({index,
                       {},
                       refine::tip_features(curve, last, frame, seen),
                       static_cast<float>(*beyond / (2 * radius_m))});
  }
}

}  // namespace

std::optional<double> beyond_m(const Centerline& nodes, const Centerline& truth, double near_m) {
  const Line line(nodes);
  const Line rope(truth);
  const auto [end_at, end_off_m] = rope.nearest(line.points.front());
  const auto [tip_at, tip_off_m] = line.nearest(rope.points.front());
  if (std::min(end_off_m, tip_off_m) > near_m) return std::nullopt;
  if (tip_at > 0 && tip_off_m <= end_off_m && end_at <= 1) return -tip_at * line.step_m;
  if (end_at > 0) return end_at * rope.step_m;
  const Eigen::Vector3d out = line.points.front() - line.points[kPoints / 32];
  if (out.norm() <= 0) return std::nullopt;
  return (rope.points.front() - line.points.front()).dot(out.normalized());
}

std::vector<TipSample> samples_of(const synth::SyntheticFrame& scene, field::Network& network) {
  Frame frame = scene.frame();
  Timings timings;
  const auto conditions =
      estimator::gather(frame, {}, timings, nullptr, estimator::seen_by(&network));
  if (!conditions || !conditions->seen) return {};
  frame = estimator::read_frame(frame, *conditions);
  const auto look = estimator::first_look(*conditions, frame);
  std::vector<TipSample> samples;
  for (const auto& hypothesis :
       estimator::list_candidates(look, conditions->paths.rope_width_px, {}, {}, {}, frame, 0)) {
    add_ends(hypothesis, scene.truth(), scene.meta.index, frame, *look.seen, samples);
  }
  return samples;
}

std::vector<TipSample> samples_of_ropes(const synth::SyntheticFrame& scene,
                                        field::Network& network) {
  Frame frame = scene.frame();
  frame.instances = {};
  const auto parted = estimator::part_ropes(frame, 0, estimator::seen_by(&network, true));
  if (!parted || !parted->seen) return {};
  std::vector<TipSample> samples;
  for (std::size_t i = 0; i < parted->paths.ropes.size(); ++i) {
    if (parted->paths.ropes[i].closed) continue;
    const estimator::RopeView view(*parted, i, frame);
    const Frame own = view.frame();
    const estimator::Traced traced = view.traced();
    Timings timings;
    const auto conditions = estimator::gather(own, {}, timings, &traced);
    if (!conditions) continue;
    const auto look = estimator::first_look(*conditions, own);
    if (!look.seen) continue;
    const auto hypotheses =
        estimator::list_candidates(look, conditions->paths.rope_width_px, {}, {}, {}, own, 0);
    for (const synth::TrueRope& rope : scene.ropes) {
      if (rope.closed) continue;
      for (const auto& hypothesis : hypotheses) {
        add_ends(hypothesis, rope.nodes, scene.meta.index, own, *look.seen, samples);
      }
    }
  }
  return samples;
}

}  // namespace flowdlo::lab
