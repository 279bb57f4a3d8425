#include "path/path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "guard/guarded.hpp"
#include "image/masks.hpp"
#include "path/doubles.hpp"
#include "path/graph.hpp"
#include "path/limits.hpp"
#include "path/links.hpp"
#include "path/ranked.hpp"
#include "path/region.hpp"
#include "path/rope_paths.hpp"
#include "path/strands.hpp"
#include "path/thinning.hpp"
#include "path/window.hpp"

namespace flowdlo::path {
namespace {

constexpr float kRaggedSpurs = 0.12F;  // spurs a width of skeleton: the border is frayed
constexpr int kRaggedLeast = 4;
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

int alive(const Graph& graph) {
  return static_cast<int>(std::count_if(graph.segments.begin(), graph.segments.end(),
                                        [](const Segment& segment) { return segment.alive; }));
}

// The graph of the mask; a frayed or noisy one is filtered first. A mask that stays a tangle of
// many segments is no rope.
Result<Graph> graph_of(Region& region) {
  Graph graph;
  int segments = 0;
  const auto read = [&] {
    segments = least_segments(region.mask);
    if (segments > kMostSegments) return;  // which is told sooner than by thinning
    graph = make_graph(thin(region.mask), region);
    segments = alive(graph);
  };
  read();
  if (ragged(graph)) {
    const int size = std::clamp(static_cast<int>(region.width_px / 3) | 1, 3, 15);
    region = smoothed(region, size);
    read();
  }
  for (int size = 5; segments > kMostSegments && size <= 21; size += 8) {
    region = smoothed(region, size);
    read();
  }
  if (segments <= kMostSegments) return graph;
  return Error{ErrorCode::kNoPath,
               fmt::format("path: expected one rope, at most {} stretches between crossings and "
                           "ends, got at least {} of a texture or of many things; check the "
                           "segmentation",
                           kMostSegments, segments)};
}

// `Answer` is what `read` makes of strands: Traversals or RopePaths.
template <class Answer>
using Read = std::function<Result<Answer>(const Strands&, const Region&, const Frame&)>;

template <class Answer>
Result<Answer> trace_graph(const Graph& graph, const Region& region, const Frame& frame,
                           bool several, const Read<Answer>& read) {
  Strands strands = make_strands(graph, region, frame);
  strands.several = several;
  return read(strands, region, frame);
}

// The answer for a mask whose doubles are cut apart; magnified, where the strands are too thin
// for a cut a pixel wide.
template <class Answer>
Result<Answer> trace_parted(const Region& region, const Doubles& doubles, const Frame& frame,
                            bool several, const Read<Answer>& read) {
  const bool large = region.mask.total() * kMagnified * kMagnified > kMostMagnifiedPixels;
  if (doubles.width_px >= kThinDoublePx || large) {
    const Region parted = cut(region, doubles.lines);
    return trace_graph(make_graph(thin(parted.mask), parted), parted, frame, several, read);
  }
  const Magnified magnified(frame, region, kMagnified);
  const Region parted = cut(magnified.region(), magnified.enlarged(doubles.lines));
  auto result =
      trace_graph(make_graph(thin(parted.mask), parted), parted, magnified.frame(), several, read);
  if (result) magnified.restore(*result);
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

// The better of both. What is wide all along is two strands where there is one rope; where there
// are several it may as well be a thicker one.
RopePaths better(RopePaths parted, RopePaths whole, int ropes) {
  const double lead = parted.ropes.front().score - whole.ropes.front().score;
  return lead < (ropes == 1 ? -kLeftOut : kLeftOut) ? std::move(whole) : std::move(parted);
}

// The answer for a mask, or for a reduced copy of one that is too large to be traced as it is.
template <class Answer, class Join>
Result<Answer> trace_mask(const Frame& frame, const Region* cleaned, int ropes,
                          const Read<Answer>& read, const Join& join) {
  const auto trace = [&](const Frame& seen, const Reduced* copy) -> Result<Answer> {
    const bool known = copy == nullptr && cleaned != nullptr;
    auto region = known ? Result<Region>(*cleaned) : clean(seen, ropes);
    if (!region) return region.error();
    const auto graph = graph_of(*region);
    if (!graph) return graph.error();
    const int most_parted = ropes == 1 ? kMostPartedSegments : kMostSegments;
    Doubles doubles;
    if (alive(*graph) <= most_parted) doubles = find_doubles(*graph, *region, seen);
    auto whole = trace_graph(*graph, *region, seen, ropes != 1, read);
    if (doubles.lines.empty() || !whole) return whole;
    auto parted = trace_parted(*region, doubles, seen, ropes != 1, read);
    if (!parted) return whole;
    return join(*std::move(parted), *std::move(whole));
  };
  return trace_reduced<Answer>(frame, trace);
}

// Length of what the region shows, in widths.
float slender(const Region& region) {
  return static_cast<float>(image::count_set(region.mask)) / (region.width_px * region.width_px);
}

}  // namespace

Result<Glance> glance(const Frame& frame) {
  return guard::guarded("path", [&]() -> Result<Glance> {
    const image::Rect box = bounding_box(frame);
    const int times = reduction_of(frame, box);
    if (times > 1) {
      const Reduced copy(frame, box, times);
      const auto region = clean(copy.frame());
      if (!region) return region.error();
      return Glance{region->width_px / copy.scale(), slender(*region), region->filtered, nullptr};
    }
    auto region = clean(frame);
    if (!region) return region.error();
    Glance result{region->width_px, slender(*region), region->filtered, nullptr};
    result.cleaned = std::make_shared<const Region>(*std::move(region));
    return result;
  });
}

Result<Traversals> trace(const Frame& frame, const TraceConfig& config) {
  const Read<Traversals> read = [&](const Strands& strands, const Region& region,
                                    const Frame& seen) {
    return rank(strands, region, seen, config);
  };
  return guard::guarded("path", [&] {
    return trace_mask(frame, config.cleaned.get(), 1, read,
                      [&](Traversals parted, const Traversals& whole) {
                        return merged(std::move(parted), whole, config);
                      });
  });
}

Result<RopePaths> trace_ropes(const Frame& frame, int ropes) {
  const Read<RopePaths> read = [&](const Strands& strands, const Region& region,
                                   const Frame& seen) {
    return rope_paths(strands, prices_of(strands, region, seen), region, seen, ropes);
  };
  return guard::guarded("path", [&] {
    return trace_mask(frame, nullptr, ropes, read, [&](RopePaths parted, RopePaths whole) {
      return better(std::move(parted), std::move(whole), ropes);
    });
  });
}

}  // namespace flowdlo::path
