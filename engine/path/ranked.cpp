#include "path/ranked.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "geometry/depth.hpp"
#include "geometry/pixel.hpp"
#include "image/masks.hpp"
#include "path/assemble.hpp"
#include "path/links.hpp"
#include "path/search.hpp"

namespace flowdlo::path {
namespace {

constexpr int kMostAlternatives = 16;
constexpr double kMarginCost = 3.0;  // cost between winner and runner-up that settles it
constexpr double kLengthTolerance = 0.08;
constexpr double kMostTooLong = 60;
constexpr double kMostTooShort = 8;  // depth may be missing where the rope goes on
constexpr int kLengthCandidates = 12;

// The length in space of a path over the depths under it, metres; 0 where depths are missing.
double length_m(const Path& path, const Frame& frame) {
  double sum = 0;
  float z_before = 0;
  const auto focal = 0.5 * static_cast<double>(frame.intrinsics.fx + frame.intrinsics.fy);
  std::size_t before = 0;
  for (std::size_t i = 0; i < path.points_px.size(); i += 4) {
    const auto u = static_cast<std::size_t>(geometry::nearest_px(path.points_px[i].x()));
    const auto v = static_cast<std::size_t>(geometry::nearest_px(path.points_px[i].y()));
    const float z = frame.depth_m[v * static_cast<std::size_t>(frame.width) + u];
    if (path.bridged[i] != 0 || !geometry::measured(z)) continue;
    if (z_before > 0) {
      const double mean = 0.5 * static_cast<double>(z + z_before);
      const double across = (path.points_px[i] - path.points_px[before]).norm() * mean / focal;
      const double along = std::min(static_cast<double>(std::abs(z - z_before)), across);
      sum += std::hypot(across, along);
    }
    z_before = z;
    before = i;
  }
  return sum;
}

void weigh_length(std::vector<Path>& paths, const Frame& frame, double rope_length_m) {
  if (rope_length_m <= 0) return;
  for (Path& path : paths) {
    const double length = length_m(path, frame);
    if (length <= 0) continue;
    const double off = (length / rope_length_m - 1) / kLengthTolerance;
    path.score -= std::min(off > 0 ? kMostTooLong : kMostTooShort, off * off);
  }
  std::stable_sort(paths.begin(), paths.end(),
                   [](const Path& a, const Path& b) { return a.score > b.score; });
}

// Directions of the camera frame as places in the region's own pixels.
std::vector<Eigen::Vector2f> places_of(const std::vector<Eigen::Vector2f>& directions,
                                       const Region& region, const Intrinsics& camera) {
  std::vector<Eigen::Vector2f> places;
  for (const Eigen::Vector2f& direction : directions) {
    places.emplace_back(
        camera.fx * direction.x() + camera.cx - static_cast<float>(region.offset_px.x),
        camera.fy * direction.y() + camera.cy - static_cast<float>(region.offset_px.y));
  }
  return places;
}

// The distinct traversals as paths, best first; the long axis where there are none.
std::vector<Path> ranked_paths(const Strands& strands, const Region& region, const Frame& frame,
                               const TraceConfig& config) {
  std::vector<Path> paths;
  const Prices prices = prices_of(strands, region, frame, {}, config.closed == true);
  const int candidates = config.rope_length_m > 0 ? kLengthCandidates : 2;
  const int count = std::max(candidates, config.alternatives + 1);
  const auto ends = places_of(config.ends, region, frame.intrinsics);
  std::vector<Traversal> ways;
  if (config.closed == true) ways = search_rings(strands, prices, count);
  if (ways.empty()) ways = search(strands, prices, count, ends);
  for (const Traversal& traversal : ways) {
    Path path = assemble(traversal, strands, region, frame);
    if (config.closed == false) path.closed = false;
    if (path.points_px.size() >= 2) paths.push_back(std::move(path));
  }
  weigh_length(paths, frame, config.rope_length_m);
  if (paths.empty()) {
    Path axis = long_axis(region, frame);
    if (axis.points_px.size() >= 2) paths.push_back(std::move(axis));
  }
  return paths;
}

// Traversals::margin of paths, best first.
float margin_of(const std::vector<Path>& ranked) {
  if (ranked.size() < 2) return 1;
  const double lead = ranked[0].score - ranked[1].score;
  return static_cast<float>(1 - std::exp(-std::max(0.0, lead) / kMarginCost));
}

}  // namespace

Result<Traversals> rank(const Strands& strands, const Region& region, const Frame& frame,
                        const TraceConfig& asked) {
  TraceConfig config = asked;
  config.alternatives = std::clamp(asked.alternatives, 0, kMostAlternatives);

  Traversals result;
  result.rope_width_px = strands.width_px;
  result.filtered = region.filtered;
  result.strands = static_cast<int>(strands.list.size());
  result.ranked = ranked_paths(strands, region, frame, config);
  if (result.ranked.empty()) {
    return Error{ErrorCode::kNoPath,
                 "path: expected a stroke longer than it is wide, got a spot of " +
                     std::to_string(image::count_set(region.mask)) +
                     " pixels; check the segmentation"};
  }
  for (Path& path : result.ranked) path.width_px = strands.width_px;
  result.margin = margin_of(result.ranked);
  const auto wanted = static_cast<std::size_t>(config.alternatives) + 1;
  if (result.ranked.size() > wanted) result.ranked.resize(wanted);
  return result;
}

}  // namespace flowdlo::path
