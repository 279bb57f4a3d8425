#include "reports/ropes_outcome.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <utility>

#include "estimator/conditions.hpp"
#include "estimator/judge.hpp"
#include "estimator/parted.hpp"
#include "estimator/rope_crossings.hpp"
#include "estimator/rope_views.hpp"
#include "eval/metrics.hpp"
#include "field/axes.hpp"
#include "field/strand_field.hpp"
#include "gate/calibrated.hpp"
#include "geometry/polyline.hpp"
#include "geometry/ring.hpp"
#include "scene/setting.hpp"

namespace flowdlo::lab {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector3d vector_of(const Point3& p) { return {p.x, p.y, p.z}; }

// What the strand field shows, and how long that took.
std::optional<field::Axes> seen_axes(const Frame& frame, const RopesRun& run, float rope_width_px,
                                     RopesOutcome& outcome) {
  const auto begin = std::chrono::steady_clock::now();
  const auto seen = field::see(frame, rope_width_px, *run.field, true);
  if (seen) outcome.axes = field::axes(*seen);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
  outcome.field_ms = took.count();
  return outcome.axes;
}

// The order in which the ropes will be told.
std::vector<std::size_t> longest_first(const std::vector<Estimate>& ropes) {
  std::vector<std::size_t> order(ropes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return geometry::length(ropes[a].nodes) > geometry::length(ropes[b].nodes);
  });
  return order;
}

// Along the path that told the rope apart.
Result<Estimate> along_path(const estimator::RopeView& view, const RopesRun& run) {
  const Frame frame = view.frame();
  Timings timings;
  const estimator::Traced traced = view.traced();
  const auto conditions = estimator::gather(frame, {}, timings, &traced);
  if (!conditions) return conditions.error();
  Estimate rope;
  rope.nodes = conditions->hypotheses.front().prior.nodes;
  rope.support = conditions->hypotheses.front().prior.support;
  if (run.judge == nullptr) return rope;
  auto& refine = run.judge->refine;
  const Hints none;
  const estimator::Judge judge(&run.judge->fitted, none, *conditions, frame, 0,
                               refine ? &*refine : nullptr);
  auto judged = judge.of_first(true);
  if (!judged) return judged.error();
  rope.nodes = (*judged)->nodes;
  rope.support = (*judged)->support;
  rope.confidence = (*judged)->confidence;
  rope.one_rope = std::move((*judged)->one_rope);
  return rope;
}

// Part by part, as the estimator does it.
Result<Ropes> by_parts(const Frame& frame, const RopesRun& run, RopesOutcome& outcome) {
  const estimator::SeeAxes see = [&](const Frame& of, float rope_width_px) {
    return seen_axes(of, run, rope_width_px, outcome);
  };
  const auto parted = estimator::part_ropes(frame, run.ropes, run.field != nullptr ? see : nullptr);
  if (!parted) return parted.error();
  Ropes result;
  for (std::size_t i = 0; i < parted->paths.ropes.size(); ++i) {
    const estimator::RopeView view(*parted, i, frame);
    const bool closed = parted->paths.ropes[i].closed;
    const bool alone = run.judge != nullptr && !frame.instances.empty() && !closed;
    auto rope = alone ? run.model->estimate(view.frame()) : along_path(view, run);
    if (!rope) return rope.error();
    rope->closed = closed;
    result.ropes.push_back(*std::move(rope));
  }
  for (const std::size_t i : longest_first(result.ropes)) {
    if (run.judge == nullptr) break;
    const estimator::ToldApart told{parted->witness[i], parted->paths.lead[i]};
    Estimate& rope = result.ropes[i];
    outcome.told.push_back(told);
    outcome.own_log_odds.push_back(estimator::own_log_odds(rope.confidence));
    rope.confidence = estimator::rope_confidence(told, rope);
  }
  result.instances = estimator::sort_longest_first(parted->instances, result.ropes);
  result.crossings = estimator::rope_crossings(result.ropes, frame);
  return result;
}

bool inside(const Vector2d& p, const Image& image) {
  return p.x() > -0.5 && p.y() > -0.5 && p.x() < image.width - 0.5 && p.y() < image.height - 0.5;
}

// The rope in the image; what of its ends lies outside is left out.
std::vector<Vector2d> line_of(const Estimate& rope, const Image& image) {
  const Intrinsics& camera = image.camera;
  std::vector<Vector2d> line;
  for (std::size_t i = 1; i < rope.nodes.size(); ++i) {
    const Vector2d from = project(camera, vector_of(rope.nodes[i - 1]));
    const Vector2d to = project(camera, vector_of(rope.nodes[i]));
    const int pieces = std::clamp(static_cast<int>((to - from).norm() / 2), 1, 200);
    for (int k = 0; k < pieces; ++k) line.push_back(from + (to - from) * k / pieces);
  }
  line.push_back(project(camera, vector_of(rope.nodes.back())));
  const auto shown = [&](const Vector2d& p) { return inside(p, image); };
  const auto first = std::find_if(line.begin(), line.end(), shown);
  const auto last = std::find_if(line.rbegin(), line.rend(), shown).base();
  if (first < last) line = std::vector<Vector2d>(first, last);
  return line;
}

// A place of a rope in the image, and how near to it a line has to be.
struct Mark {
  Vector2d point_px{0, 0};
  double tolerance_px = 0;
};

// Places along a rope: `first` to `last` are those that the image shows. A line may end there, or
// go on along what is hidden.
struct Marks {
  std::vector<Mark> all;
  std::size_t first = 0;
  std::size_t last = 0;

  void reverse() {
    std::reverse(all.begin(), all.end());
    std::tie(first, last) = std::pair(all.size() - 1 - last, all.size() - 1 - first);
  }
};

// True when path and marks can be walked together from end to end, never back.
bool visits_in_order(const std::vector<Vector2d>& path, const Marks& marks) {
  std::vector<char> reached(marks.all.size(), 0);
  for (std::size_t i = 0; i < path.size(); ++i) {
    char diagonal = 0;
    for (std::size_t j = 0; j < marks.all.size(); ++j) {
      const char above = i > 0 ? reached[j] : 0;
      const char left = j > 0 ? reached[j - 1] : 0;
      const bool begins = i == 0 && j <= marks.first;
      const bool from = begins || above != 0 || left != 0 || diagonal != 0;
      const Mark& mark = marks.all[j];
      const bool near = (path[i] - mark.point_px).norm() <= mark.tolerance_px;
      reached[j] = from && near ? 1 : 0;
      diagonal = above;
    }
  }
  const auto ends = reached.begin() + static_cast<std::ptrdiff_t>(marks.last);
  return std::any_of(ends, reached.end(), [](char there) { return there != 0; });
}

Marks marks_of(const SeenRope& rope, const Intrinsics& camera) {
  Marks marks;
  const auto add = [&](const Curve3& curve) {
    if (curve.size() < 2) return;
    for (const Vector3d& p : respaced(curve, 0.7 * rope.radius_m)) {
      marks.all.push_back({project(camera, p), 2 * rope.radius_m * camera.fx / p.z() + 3});
    }
  };
  add(rope.unseen[0]);
  marks.first = marks.all.size();
  add(rope.curve);
  marks.last = marks.all.size() - 1;
  add(rope.unseen[1]);
  return marks;
}

// A ring is visited from wherever the line begins.
bool visits(const std::vector<Vector2d>& line, Marks marks, bool closed) {
  std::vector<Mark>& all = marks.all;
  if (closed) {
    const auto nearest =
        std::min_element(all.begin(), all.end(), [&](const Mark& a, const Mark& b) {
          return (a.point_px - line.front()).norm() < (b.point_px - line.front()).norm();
        });
    std::rotate(all.begin(), nearest, all.end());
  }
  if (visits_in_order(line, marks)) return true;
  if (closed) std::rotate(all.begin(), all.begin() + 1, all.end());
  marks.reverse();
  return visits_in_order(line, marks);
}

// Eq. (4.1) in the better direction; of a ring from the best beginning.
double index_m(const Estimate& found, const SeenRope& rope) {
  if (rope.closed) return geometry::mean_distance(rope.truth, found.nodes, true);
  return eval::score(found.nodes, rope.truth).either_index_m;
}

// Where two true ropes cross in the image, and which is nearer there.
struct TrueCrossing {
  std::size_t over = 0;
  std::size_t under = 0;
  Vector2d at_px{0, 0};
};

std::vector<TrueCrossing> true_crossings(const RopesScene& scene) {
  std::vector<TrueCrossing> result;
  const auto side = [](const Vector2d& p, const Vector2d& q) {
    return p.x() * q.y() - p.y() * q.x();
  };
  for (std::size_t a = 0; a < scene.ropes.size(); ++a) {
    for (std::size_t b = a + 1; b < scene.ropes.size(); ++b) {
      const Curve3& one = scene.ropes[a].curve;
      const Curve3& two = scene.ropes[b].curve;
      for (std::size_t i = 1; i < one.size(); ++i) {
        const Vector2d p = project(scene.image.camera, one[i - 1]);
        const Vector2d d = project(scene.image.camera, one[i]) - p;
        for (std::size_t j = 1; j < two.size(); ++j) {
          const Vector2d q = project(scene.image.camera, two[j - 1]);
          if ((q - p).squaredNorm() > 400) continue;
          const Vector2d e = project(scene.image.camera, two[j]) - q;
          const double cross = side(d, e);
          if (std::abs(cross) < 1e-12) continue;
          const double t = side(q - p, e) / cross;
          const double s = side(q - p, d) / cross;
          if (t < 0 || t >= 1 || s < 0 || s >= 1) continue;
          const bool first = one[i].z() < two[j].z();
          result.push_back({first ? a : b, first ? b : a, p + t * d});
        }
      }
    }
  }
  return result;
}

Vector2d place_on(const Estimate& rope, double along_m, const Intrinsics& camera) {
  double walked = 0;
  const std::size_t count = rope.nodes.size();
  for (std::size_t i = 1; i <= count; ++i) {
    const Vector3d from = vector_of(rope.nodes[i - 1]);
    const Vector3d to = vector_of(rope.nodes[i % count]);
    const double step = (to - from).norm();
    if (walked + step >= along_m) {
      return project(camera, from + (to - from) * ((along_m - walked) / std::max(1e-9, step)));
    }
    walked += step;
  }
  return project(camera, vector_of(rope.nodes.back()));
}

// `of` [true ropes] which of the found each is; -1: none.
void compare_crossings(const RopesScene& scene, const Ropes& found, const std::vector<int>& of,
                       RopesOutcome& outcome) {
  for (const TrueCrossing& truth : true_crossings(scene)) {
    const int over = of[truth.over];
    const int under = of[truth.under];
    if (over < 0 || under < 0) continue;
    ++outcome.crossings;
    const Vector3d& near = scene.ropes[truth.over].curve.front();
    const double reach =
        4 * scene.ropes[truth.over].radius_m * 2 * scene.image.camera.fx / near.z() + 4;
    for (const RopeCrossing& told : found.crossings) {
      const bool same =
          (told.over == over && told.under == under) || (told.over == under && told.under == over);
      if (!same) continue;
      const Vector2d at = place_on(found.ropes[static_cast<std::size_t>(told.over)],
                                   static_cast<double>(told.over_at_m), scene.image.camera);
      if ((at - truth.at_px).norm() > reach) continue;
      ++outcome.crossings_found;
      outcome.crossings_right += told.over == over ? 1 : 0;
      break;
    }
  }
}

}  // namespace

RopesOutcome outcome_of(const RopesScene& scene, const RopesRun& run) {
  RopesOutcome outcome;
  const Frame frame = scene.frame(run.labels);
  const auto start = std::chrono::steady_clock::now();
  const bool whole = run.model != nullptr && run.judge == nullptr;
  auto answer = whole ? run.model->estimate_ropes(frame) : by_parts(frame, run, outcome);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  outcome.total_ms = took.count();
  if (!answer) {
    outcome.error = answer.error().message;
    return outcome;
  }
  outcome.found = static_cast<int>(answer->ropes.size());
  outcome.parting_ms = answer->parting_ms;
  outcome.rope_right.assign(answer->ropes.size(), false);
  outcome.rope_close.assign(answer->ropes.size(), false);
  std::vector<std::vector<Vector2d>> lines;
  for (const Estimate& rope : answer->ropes) {
    lines.push_back(line_of(rope, scene.image));
    if (run.model != nullptr) outcome.confidence.push_back(static_cast<double>(rope.confidence));
  }
  std::vector<int> of(scene.ropes.size(), -1);
  for (std::size_t r = 0; r < scene.ropes.size(); ++r) {
    const SeenRope& rope = scene.ropes[r];
    const auto marks = marks_of(rope, scene.image.camera);
    for (std::size_t f = 0; f < lines.size() && of[r] < 0; ++f) {
      if (outcome.rope_right[f] || answer->ropes[f].closed != rope.closed) continue;
      if (visits(lines[f], marks, rope.closed)) of[r] = static_cast<int>(f);
    }
    if (of[r] < 0) continue;
    const auto found = static_cast<std::size_t>(of[r]);
    outcome.rope_right[found] = true;
    ++outcome.right;
    outcome.index_cm.push_back(100 * index_m(answer->ropes[found], rope));
    outcome.rope_close[found] = outcome.index_cm.back() < 100 * gate::kCloseError_m;
  }
  const auto wanted = static_cast<int>(scene.ropes.size());
  outcome.all_right = outcome.found == wanted && outcome.right == wanted;
  compare_crossings(scene, *answer, of, outcome);
  outcome.instances = std::move(answer->instances);
  outcome.ropes = std::move(answer->ropes);
  return outcome;
}

}  // namespace flowdlo::lab
