#include "path/path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "geometry/mask_box.hpp"
#include "guard/guarded.hpp"
#include "image/masks.hpp"
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

// What `read` makes of the mask's own strands, or of those of a reduced copy of a mask that is too
// large to be traced as it is.
template <class Answer, class Read>
Result<Answer> trace_mask(const Frame& frame, const Region* cleaned, int ropes, const Read& read) {
  return trace_reduced<Answer>(
      frame, [&](const Frame& seen, const Reduced* copy) -> Result<Answer> {
        const bool known = copy == nullptr && cleaned != nullptr;
        auto region = known ? Result<Region>(*cleaned) : clean(seen, ropes);
        if (!region) return region.error();
        const auto graph = graph_of(*region);
        if (!graph) return graph.error();
        Strands strands = make_strands(*graph, *region, seen);
        strands.several = ropes != 1;
        return read(strands, *region, seen, copy);
      });
}

// Length of what the region shows, in widths.
float slender(const Region& region) {
  return static_cast<float>(image::count_set(region.mask)) / (region.width_px * region.width_px);
}

}  // namespace

Result<Glance> glance(const Frame& frame) {
  return guard::guarded("path", [&]() -> Result<Glance> {
    const image::Rect box = geometry::mask_box(frame);
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
  return guard::guarded("path", [&] {
    return trace_mask<Traversals>(
        frame, config.cleaned.get(), 1,
        [&](const Strands& strands, const Region& region, const Frame& seen, const Reduced*) {
          return rank(strands, region, seen, config);
        });
  });
}

Result<RopePaths> trace_ropes(const Frame& frame, int ropes, const std::vector<Path>& before) {
  return guard::guarded("path", [&] {
    return trace_mask<RopePaths>(
        frame, nullptr, ropes,
        [&](const Strands& strands, const Region& region, const Frame& seen, const Reduced* copy) {
          return rope_paths(strands, prices_of(strands, region, seen), region, seen,
                            {ropes, copy == nullptr ? before : copy->paths_in(before)});
        });
  });
}

}  // namespace flowdlo::path
