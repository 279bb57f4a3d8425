#include "path/eroded.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "guard/guarded.hpp"
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
cv::Mat shrunk(const cv::Mat& mask, int radius_px) {
  cv::Mat result;
  if (radius_px <= kMostBrushPx) {
    const cv::Size size(2 * radius_px + 1, 2 * radius_px + 1);
    cv::erode(mask, result, cv::getStructuringElement(cv::MORPH_ELLIPSE, size));
    return result;
  }
  cv::distanceTransform(mask, result, cv::DIST_L2, 5);
  return result > static_cast<float>(radius_px);
}

Result<Traversals> trace_without_border(const Frame& frame, float rope_width_px,
                                        const TraceConfig& config) {
  const cv::Rect box = bounding_box(frame);
  const int around_px = kAroundPx + kAroundWidths * static_cast<int>(std::lround(rope_width_px));
  const Window window{widened(box, around_px, {frame.width, frame.height}), 1};
  const int radius_px = std::max(1, static_cast<int>(std::lround(kShare * rope_width_px)));
  cv::Mat mask = mask_in(frame, window.part);
  cv::threshold(mask, mask, 127, 255, cv::THRESH_BINARY);
  mask = shrunk(mask, radius_px);
  const cv::Mat depth_m = depth_in(frame, window.part);
  const cv::Mat instances = instances_in(frame, window.part);
  auto result = trace(frame_of(mask, depth_m, instances, window.camera(frame.intrinsics)), config);
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
