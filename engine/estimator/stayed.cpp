#include "estimator/stayed.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/camera.hpp"
#include "geometry/pixel.hpp"
#include "geometry/polyline.hpp"
#include "geometry/ring.hpp"
#include "path/limits.hpp"
#include "prior/refined_prior.hpp"

namespace flowdlo::estimator {
namespace {

using Eigen::Vector2f;

bool on_mask(const Vector2f& place, const Frame& frame) {
  if (!(place.x() >= 0 && place.y() >= 0)) return false;
  const auto u = static_cast<std::size_t>(geometry::nearest_px(place.x()));
  const auto v = static_cast<std::size_t>(geometry::nearest_px(place.y()));
  if (u >= static_cast<std::size_t>(frame.width) || v >= static_cast<std::size_t>(frame.height)) {
    return false;
  }
  return frame.mask[v * static_cast<std::size_t>(frame.width) + u] > 127;
}

/// The nodes in the image, samples about a pixel apart. None where a node cannot be seen or all of
/// it is longer than what is read of a mask.
std::optional<path::Path> projected(const Centerline& nodes, const Frame& frame) {
  std::vector<Vector2f> corners;
  for (const Point3& node : nodes) {
    if (!(node.z > 0)) return std::nullopt;
    corners.push_back(geometry::project(frame.intrinsics, node));
    if (!corners.back().allFinite()) return std::nullopt;
  }
  const float length_px = geometry::cumulative_length(corners).back();
  const auto most_px = static_cast<float>(path::kMostRereadSides * (frame.width + frame.height));
  if (!(length_px >= 1 && length_px <= most_px)) return std::nullopt;
  path::Path path;
  for (const Vector2f& place : geometry::resample(corners, static_cast<int>(length_px) + 2)) {
    if (!path.points_px.empty() && path.points_px.back() == place) continue;
    path.points_px.push_back(place);
    path.bridged.push_back(on_mask(place, frame) ? 0 : 1);
  }
  if (path.points_px.size() < 2) return std::nullopt;
  return path;
}

/// The hypothesis that goes the same way; null where none does.
const Hypothesis* same_way(const Centerline& nodes, const std::vector<Hypothesis>& known) {
  const Hypothesis* nearest = nullptr;
  double least = kSameWay * static_cast<double>(geometry::length(nodes));
  for (const Hypothesis& hypothesis : known) {
    const double off =
        geometry::mean_distance(hypothesis.prior.nodes, nodes, hypothesis.course.closed);
    if (!(off < least)) continue;
    least = off;
    nearest = &hypothesis;
  }
  return nearest;
}

/// `nodes` in the direction in which they fit `others`.
Centerline turned_to(const Centerline& others, Centerline nodes) {
  double forward = 0;
  double backward = 0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    forward += geometry::distance(nodes[i], others[i]);
    backward += geometry::distance(nodes[kNodes - 1 - i], others[i]);
  }
  if (backward < forward) std::reverse(nodes.begin(), nodes.end());
  return nodes;
}

}  // namespace

std::optional<Hypothesis> stayed(const std::optional<Centerline>& previous,
                                 const std::vector<Hypothesis>& known, const Conditions& conditions,
                                 const Frame& frame) {
  if (!previous || !geometry::all_finite(*previous)) return std::nullopt;
  auto path = projected(*previous, frame);
  if (!path) return std::nullopt;
  const Hypothesis* like = same_way(*previous, known);
  // Between the nodes of a ring nothing says whether it was one; the hypothesis does.
  if (like != nullptr && like->course.closed) return std::nullopt;
  if (like != nullptr) {
    path->score = like->score;
    path->ring = like->course.ring;
    path->hidden_ends = like->course.hidden_ends;
    path->buried_ends = like->course.buried_ends;
  } else {
    for (const Hypothesis& other : known) path->score = std::min(path->score, other.score);
  }
  const float width_px = conditions.paths.rope_width_px;
  auto lifted = prior::refine(*path, width_px, conditions.cloud, conditions.visible, frame);
  if (!lifted) return std::nullopt;
  lifted->nodes = turned_to(lifted->nodes, *previous);
  Hypothesis hypothesis;
  hypothesis.prior = *std::move(lifted);
  hypothesis.score = path->score;
  hypothesis.course = course_of(*path, width_px);
  hypothesis.reading = like != nullptr ? like->reading : 1;
  hypothesis.votes = like != nullptr ? like->votes : 0;
  hypothesis.odds = like != nullptr ? like->odds : 0;
  hypothesis.seen_odds = like != nullptr ? like->seen_odds : 0;
  return hypothesis;
}

}  // namespace flowdlo::estimator
