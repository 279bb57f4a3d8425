#include "estimator/several.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "estimator/parted.hpp"
#include "estimator/rope_confidence.hpp"
#include "estimator/rope_crossings.hpp"
#include "estimator/rope_views.hpp"
#include "estimator/stopwatch.hpp"
#include "field/ridge.hpp"
#include "geometry/camera.hpp"
#include "geometry/polyline.hpp"

namespace flowdlo::estimator {
namespace {

// Path::ends_met from which on what seems to be a ring has two ends that touch.
constexpr float kEndsMet = field::kTipPeak;

// Where a rope of the frame before lies in this one; nothing of one that cannot be drawn.
std::optional<path::Path> path_of(const KnownRope& known, const Intrinsics& camera) {
  if (!geometry::all_finite(known.nodes)) return std::nullopt;
  path::Path path;
  for (const Point3& node : known.nodes) {
    if (!(node.z > 0)) return std::nullopt;
    path.points_px.push_back(geometry::project(camera, node));
  }
  path.closed = known.closed;
  return path;
}

// The ropes of the frame before that can be drawn in this one.
struct Drawn {
  std::vector<path::Path> paths;
  std::vector<Centerline> nodes;  // [paths]
};

Drawn drawn(const std::vector<KnownRope>& ropes, const Intrinsics& camera) {
  Drawn result;
  for (const KnownRope& rope : ropes) {
    auto path = path_of(rope, camera);
    if (!path) continue;
    result.paths.push_back(*std::move(path));
    result.nodes.push_back(rope.nodes);
  }
  return result;
}

double apart_px(const std::vector<Eigen::Vector2f>& a, const std::vector<Eigen::Vector2f>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>((a[i] - b[i]).norm());
  return sum / static_cast<double>(a.size());
}

// The nodes of the one that lies nearest to a path, whichever end comes first.
std::optional<Centerline> nearest(const path::Path& path, const Drawn& before) {
  const auto points = geometry::resample(path.points_px, static_cast<int>(kNodes));
  const std::vector<Eigen::Vector2f> back(points.rbegin(), points.rend());
  std::optional<Centerline> found;
  double least_px = std::numeric_limits<double>::max();
  for (std::size_t k = 0; k < before.paths.size(); ++k) {
    const auto& other = before.paths[k].points_px;
    const double px = std::min(apart_px(points, other), apart_px(back, other));
    if (px >= least_px) continue;
    least_px = px;
    found = before.nodes[k];
  }
  return found;
}

Result<void> one_rope(const Frame& frame, const EstimateOne& one,
                      const std::vector<KnownRope>& before, Ropes& result) {
  Part part;
  if (before.size() == 1) part.hints.previous = before.front().nodes;
  auto rope = one(frame, part, 1);
  if (!rope) return rope.error();
  result.ropes.push_back(*std::move(rope));
  result.instances = one_instance(frame);
  return {};
}

Result<void> several_ropes(const Frame& frame, int ropes, const EstimateOne& one,
                           const SeeAxes& see, const std::vector<KnownRope>& before,
                           Ropes& result) {
  Stopwatch stage;
  const Drawn seen = drawn(before, frame.intrinsics);
  const auto parted = part_ropes(frame, ropes, see, seen.paths);
  if (!parted) return parted.error();
  stage.lap(result.parting_ms);
  const std::size_t count = parted->paths.ropes.size();
  const path::Path& first = parted->paths.ropes.front();
  const bool ring = first.closed && first.ends_met < kEndsMet;
  // All readings of a rope that is alone are the whole frame's; they know rings that nothing parts.
  if (count == 1 && frame.instances.empty() && !ring) return one_rope(frame, one, before, result);
  std::vector<std::uint16_t> number(count + 1,
                                    0);  // of each label among those that have an estimate
  std::optional<Error> first_fault;
  for (std::size_t i = 0; i < count; ++i) {
    const RopeView view(*parted, i, frame);
    const Traced traced = view.traced();
    // A label says which pixels are a rope's: it is read in all ways, as one that is alone. That
    // it is a ring its path alone knows.
    const bool closed = parted->paths.ropes[i].closed;
    const bool labelled = !frame.instances.empty() && !closed;
    const ToldApart told{parted->witness[i], parted->paths.lead[i]};
    Part part{.traced = labelled ? nullptr : &traced};
    if (labelled) part.hints.previous = nearest(parted->paths.ropes[i], seen);
    // Where a rope is alone there was nothing to tell apart.
    const bool one_of_several = count > 1 || closed;
    if (one_of_several) {
      part.in_all = [&](double own) { return rope_probability(told, closed, own); };
    }
    auto rope = one(view.frame(), part, 1 / static_cast<double>(count - i));
    if (!rope) {
      if (rope.error().code == ErrorCode::kOutOfMemory) return rope.error();
      if (rope.error().code == ErrorCode::kDeviceLost) return rope.error();
      if (!first_fault) {
        first_fault = Error{rope.error().code,
                            fmt::format("rope {} of {}: {}", i + 1, count, rope.error().message)};
      }
      continue;
    }
    rope->closed = closed;
    if (one_of_several) rope->confidence = rope_confidence(told, *rope);
    result.ropes.push_back(*std::move(rope));
    number[i + 1] = static_cast<std::uint16_t>(result.ropes.size());
  }
  if (result.ropes.empty() && first_fault) return *first_fault;
  std::vector<std::uint16_t> instances = parted->instances;
  for (std::uint16_t& label : instances) label = number[label];
  result.instances = sort_longest_first(std::move(instances), result.ropes);
  return {};
}

}  // namespace

Result<Ropes> estimate_each(const Frame& frame, int ropes, const EstimateOne& one,
                            const SeeAxes& see, const std::vector<KnownRope>& before) {
  Stopwatch total;
  Ropes result;
  const bool alone = ropes == 1 && frame.instances.empty();
  auto done = alone ? one_rope(frame, one, before, result)
                    : several_ropes(frame, ropes, one, see, before, result);
  if (!done) return done.error();
  result.crossings = rope_crossings(result.ropes, frame);
  total.lap(result.total_ms);
  return result;
}

}  // namespace flowdlo::estimator
