#include "path/path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <string>

#include "geometry/depth.hpp"
#include "geometry/pixel.hpp"
#include "guard/guarded.hpp"
#include "path/assemble.hpp"
#include "path/bonds.hpp"
#include "path/cover.hpp"
#include "path/doubles.hpp"
#include "path/graph.hpp"
#include "path/hidden_forks.hpp"
#include "path/limits.hpp"
#include "path/magnified.hpp"
#include "path/reduced.hpp"
#include "path/region.hpp"
#include "path/rings.hpp"
#include "path/search.hpp"
#include "path/strands.hpp"
#include "path/thinning.hpp"

namespace flowdlo::path {
namespace {

constexpr float kRaggedSpurs = 0.12F;  // spurs a width of skeleton: the border is frayed
constexpr int kRaggedLeast = 4;
constexpr int kMostAlternatives = 16;
constexpr double kMarginCost = 3.0;  // cost between winner and runner-up that settles it
constexpr double kLengthTolerance = 0.08;
constexpr double kMostTooLong = 60;
constexpr double kMostTooShort = 8;  // depth may be missing where the rope goes on
constexpr int kLengthCandidates = 12;
constexpr float kThinDoublePx = 6.0F;    // strands thinner than this are cut apart magnified,
constexpr int kMagnified = 2;            // by this
constexpr double kLeftOut = 6;           // what it costs to leave one of two strands out
constexpr double kMostWorseParted = 11;  // nor do cuts help that make all this much worse

float skeleton_length(const Graph& graph) {
  float sum = 0;
  for (const Segment& segment : graph.segments) sum += segment.alive ? segment.length_px : 0;
  return sum;
}

bool ragged(const Graph& graph) {
  return graph.pruned >= kRaggedLeast &&
         static_cast<float>(graph.pruned) * graph.width_px > kRaggedSpurs * skeleton_length(graph);
}

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

int alive(const Graph& graph) {
  return static_cast<int>(std::count_if(graph.segments.begin(), graph.segments.end(),
                                        [](const Segment& segment) { return segment.alive; }));
}

// The graph of the mask; a frayed or noisy one is filtered first. A mask that stays a tangle of
// many segments is no rope.
Result<Graph> graph_of(Region& region) {
  Graph graph = make_graph(thin(region.mask), region);
  if (ragged(graph)) {
    const int size = std::clamp(static_cast<int>(region.width_px / 3) | 1, 3, 15);
    region = smoothed(region, size);
    graph = make_graph(thin(region.mask), region);
  }
  for (int size = 5; alive(graph) > kMostSegments && size <= 21; size += 8) {
    region = smoothed(region, size);
    graph = make_graph(thin(region.mask), region);
  }
  if (alive(graph) <= kMostSegments) return graph;
  return Error{ErrorCode::kNoPath,
               fmt::format("path: expected one rope, at most {} stretches between crossings and "
                           "ends, got {} of a texture or of many things; check the segmentation",
                           kMostSegments, alive(graph))};
}

// The distinct traversals as paths, best first; the long axis where there are none.
std::vector<Path> ranked_paths(const Strands& strands, const Region& region, const Frame& frame,
                               const TraceConfig& config) {
  std::vector<Path> paths;
  const auto bonds = make_bonds(strands, region, frame);
  const int candidates = config.rope_length_m > 0 ? kLengthCandidates : 2;
  const int count = std::max(candidates, config.alternatives + 1);
  for (const Traversal& traversal : search(strands, bonds, count)) {
    Path path = assemble(traversal, strands, region, frame);
    if (path.points_px.size() >= 2) paths.push_back(std::move(path));
  }
  weigh_length(paths, frame, config.rope_length_m);
  if (paths.empty()) {
    Path axis = long_axis(region, frame);
    if (axis.points_px.size() >= 2) paths.push_back(std::move(axis));
  }
  return paths;
}

float margin_of(const std::vector<Path>& ranked) {
  if (ranked.size() < 2) return 1;
  const double lead = ranked[0].score - ranked[1].score;
  return static_cast<float>(1 - std::exp(-std::max(0.0, lead) / kMarginCost));
}

Result<Traversals> trace_graph(Graph& graph, const Region& region, const Frame& frame,
                               const TraceConfig& asked) {
  split_at_hidden_forks(graph, Cover(region, frame, graph.width_px));
  open_rings(graph, region);
  const Strands strands = make_strands(graph, region, frame);
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
                     std::to_string(cv::countNonZero(region.mask)) +
                     " pixels; check the segmentation"};
  }
  for (Path& path : result.ranked) path.width_px = strands.width_px;
  result.margin = margin_of(result.ranked);
  const auto wanted = static_cast<std::size_t>(config.alternatives) + 1;
  if (result.ranked.size() > wanted) result.ranked.resize(wanted);
  return result;
}

// The traversals of a mask whose doubles are cut apart; magnified, where the strands are too thin
// for a cut a pixel wide.
Result<Traversals> trace_parted(const Region& region, const Doubles& doubles, const Frame& frame,
                                const TraceConfig& config) {
  const bool large = region.mask.total() * kMagnified * kMagnified > kMostMagnifiedPixels;
  if (doubles.width_px >= kThinDoublePx || large) {
    const Region parted = cut(region, doubles.lines);
    Graph graph = make_graph(thin(parted.mask), parted);
    return trace_graph(graph, parted, frame, config);
  }
  const Magnified magnified(frame, region, kMagnified);
  const Region parted = cut(magnified.region(), magnified.enlarged(doubles.lines));
  Graph graph = make_graph(thin(parted.mask), parted);
  auto result = trace_graph(graph, parted, magnified.frame(), config);
  if (result) magnified.shrink(*result);
  return result;
}

// Both in one, best first. Those of the mask as it is leave out one of two strands where there are
// two: they pay for it.
Traversals merged(Traversals parted, const Traversals& whole, const TraceConfig& config) {
  const double lead = parted.ranked.front().score - whole.ranked.front().score;
  if (lead < -kMostWorseParted) return whole;
  for (Path path : whole.ranked) {
    path.score -= kLeftOut;
    parted.ranked.push_back(std::move(path));
  }
  std::stable_sort(parted.ranked.begin(), parted.ranked.end(),
                   [](const Path& a, const Path& b) { return a.score > b.score; });
  const auto wanted = static_cast<std::size_t>(std::max(0, config.alternatives)) + 1;
  if (parted.ranked.size() > wanted) parted.ranked.resize(wanted);
  parted.margin = margin_of(parted.ranked);
  parted.rope_width_px = parted.ranked.front().width_px;
  return parted;
}

Result<Traversals> trace_region(const Frame& frame, const TraceConfig& config) {
  auto region = clean(frame);
  if (!region) return region.error();
  auto graph = graph_of(*region);
  if (!graph) return graph.error();
  const Doubles doubles = find_doubles(*graph, *region, frame);
  auto whole = trace_graph(*graph, *region, frame, config);
  if (doubles.lines.empty() || !whole) return whole;
  auto parted = trace_parted(*region, doubles, frame, config);
  if (!parted) return whole;
  return merged(*std::move(parted), *whole, config);
}

// The traversals of a mask that is too large to be traced as it is.
Result<Traversals> trace_reduced(const Frame& frame, const cv::Rect& box, int times,
                                 const TraceConfig& config) {
  const Reduced reduced(frame, box, times);
  auto result = trace_region(reduced.frame(), config);
  if (result) reduced.enlarge(*result);
  return result;
}

}  // namespace

Result<Traversals> trace(const Frame& frame, const TraceConfig& config) {
  return guard::guarded("path", [&] {
    const cv::Rect box = bounding_box(frame);
    const int times = reduction_of(box);
    return times == 1 ? trace_region(frame, config) : trace_reduced(frame, box, times, config);
  });
}

}  // namespace flowdlo::path
