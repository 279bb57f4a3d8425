#include "path/eroded.hpp"

#include <algorithm>
#include <cmath>

#include "guard/guarded.hpp"
#include "image/brush.hpp"
#include "image/distance.hpp"
#include "image/masks.hpp"
#include "path/region.hpp"
#include "path/window.hpp"

namespace flowdlo::path {
namespace {

constexpr int kAroundPx = 24;        // beside the mask, and this many of the rope's
constexpr int kAroundWidths = 2;     // widths: what lies there tells of occluders
constexpr float kShare = 1.0F / 16;  // of the rope's width from each side
constexpr int kMostBrushPx = 16;     // the radius of a disc that is drawn pixel by pixel
constexpr float kLeastWidthPx = 1.0F;

// `mask` without what lies within `radius_px` of an empty pixel. A large disc is a distance:
// brushes cost as much as they have pixels.
image::Mask shrunk(const image::Mask& mask, int radius_px) {
  if (radius_px <= kMostBrushPx) return image::eroded_by_disc(mask, radius_px);
  return image::above(image::distance_to_empty(mask), static_cast<float>(radius_px), 255);
}

Result<Traversals> trace_without_border(const Frame& frame, float rope_width_px,
                                        const TraceConfig& config) {
  const image::Rect box = bounding_box(frame);
  const int around_px = kAroundPx + kAroundWidths * static_cast<int>(std::lround(rope_width_px));
  const Window window{widened(box, around_px, {frame.width, frame.height}), 1};
  const int radius_px = std::max(1, static_cast<int>(std::lround(kShare * rope_width_px)));
  const image::Mask mask = shrunk(image::above(mask_in(frame, window.part), 127, 255), radius_px);
  const auto depth_m = depth_in(frame, window.part);
  const auto instances = instances_in(frame, window.part);
  TraceConfig own = config;
  own.cleaned = nullptr;  // that is the mask with its border
  auto result = trace(frame_of(mask, depth_m, instances, window.camera(frame.intrinsics)), own);
  if (!result) return result;
  window.restore(*result, {frame.width, frame.height});
  const float less_px = 2 * static_cast<float>(radius_px);
  result->rope_width_px = std::max(kLeastWidthPx, result->rope_width_px + less_px);
  for (Path& path : result->ranked)
    path.width_px = std::max(kLeastWidthPx, path.width_px + less_px);
  return result;
}

}  // namespace

Result<Traversals> trace_eroded(const Frame& frame, float rope_width_px,
                                const TraceConfig& config) {
  return guard::guarded("path", [&]() -> Result<Traversals> {
    if (bounding_box(frame).empty()) return trace(frame, config);  // which says why there is none
    return trace_reduced<Traversals>(frame, [&](const Frame& seen, const Reduced* copy) {
      const float scale = copy == nullptr ? 1 : copy->scale();
      return trace_without_border(seen, scale * rope_width_px, config);
    });
  });
}

}  // namespace flowdlo::path
