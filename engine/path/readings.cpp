#include "path/readings.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "geometry/depth.hpp"
#include "guard/guarded.hpp"
#include "path/limits.hpp"
#include "path/region.hpp"
#include "path/window.hpp"

namespace flowdlo::path {
namespace {

constexpr int kAroundPx = 24;     // beside the mask, and this many of the rope's widths: what lies
constexpr int kAroundWidths = 2;  // there tells of occluders
constexpr float kLeastUnmeasured = 1.0F;   // squared widths of mask without depth worth a reading
constexpr float kErodedShare = 1.0F / 16;  // of the rope's width from each side,
constexpr float kDilatedShare = 1.0F / 8;  // and to each side,
constexpr int kLeastErodedPx = 1;          // but at least this
constexpr int kLeastDilatedPx = 2;
constexpr int kMostBrushPx = 16;  // the radius of a disc that is drawn pixel by pixel
constexpr float kLeastWidthPx = 1.0F;

// The mask and what lies around it, read anew.
struct Reread {
  Window window;
  cv::Mat mask;        // u8, 0 or 255
  cv::Mat depth_m;     // f32
  float grown_px = 0;  // of the rope's width, in pixels of the frame
};

cv::Mat disc(int radius_px) {
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius_px + 1, 2 * radius_px + 1});
}

// `mask` without what lies within `radius_px` of an empty pixel. A large disc is a distance:
// brushes cost as much as they have pixels.
cv::Mat shrunk(const cv::Mat& mask, int radius_px) {
  cv::Mat result;
  if (radius_px <= kMostBrushPx) {
    cv::erode(mask, result, disc(radius_px));
    return result;
  }
  cv::distanceTransform(mask, result, cv::DIST_L2, 5);
  return result > static_cast<float>(radius_px);
}

int share_of(float width_px, float share, int least_px) {
  return std::max(least_px, static_cast<int>(std::lround(share * width_px)));
}

// Its sides are even numbers of pixels, so that two always make one.
void pad_to_even(Reread& reread) {
  const int right = reread.mask.cols % 2;
  const int bottom = reread.mask.rows % 2;
  cv::copyMakeBorder(reread.mask, reread.mask, 0, bottom, 0, right, cv::BORDER_REPLICATE);
  cv::copyMakeBorder(reread.depth_m, reread.depth_m, 0, bottom, 0, right, cv::BORDER_REPLICATE);
}

void rescale(Reread& reread, float scale) {
  const cv::Size size(static_cast<int>(std::lround(scale * static_cast<float>(reread.mask.cols))),
                      static_cast<int>(std::lround(scale * static_cast<float>(reread.mask.rows))));
  cv::resize(reread.mask, reread.mask, size, 0, 0, scale > 1 ? cv::INTER_CUBIC : cv::INTER_AREA);
  cv::threshold(reread.mask, reread.mask, 127, 255, cv::THRESH_BINARY);
  cv::resize(reread.depth_m, reread.depth_m, size, 0, 0, cv::INTER_NEAREST);
  reread.window.scale = scale;
}

void keep_measured(Reread& reread) {
  for (int v = 0; v < reread.mask.rows; ++v) {
    for (int u = 0; u < reread.mask.cols; ++u) {
      if (!geometry::measured(reread.depth_m.at<float>(v, u)))
        reread.mask.at<std::uint8_t>(v, u) = 0;
    }
  }
  cv::morphologyEx(reread.mask, reread.mask, cv::MORPH_CLOSE, disc(1));
}

Reread reread_as(Reading reading, const Frame& frame, const cv::Rect& box, float width_px) {
  const int around = kAroundPx + kAroundWidths * static_cast<int>(std::lround(width_px));
  const cv::Rect part = widened(box, around, {frame.width, frame.height});
  Reread reread{{part, 1}, mask_in(frame, part), depth_in(frame, part)};
  cv::threshold(reread.mask, reread.mask, 127, 255, cv::THRESH_BINARY);
  switch (reading) {
    case Reading::kAsGiven:
      break;
    case Reading::kHalved:
      pad_to_even(reread);
      rescale(reread, 0.5F);
      break;
    case Reading::kDoubled:
      rescale(reread, 2);
      break;
    case Reading::kEroded: {
      const int radius_px = share_of(width_px, kErodedShare, kLeastErodedPx);
      reread.mask = shrunk(reread.mask, radius_px);
      reread.grown_px = -2.0F * static_cast<float>(radius_px);
      break;
    }
    case Reading::kDilated: {
      const int radius_px = share_of(width_px, kDilatedShare, kLeastDilatedPx);
      reread.mask = 255 - shrunk(255 - reread.mask, radius_px);
      reread.grown_px = 2.0F * static_cast<float>(radius_px);
      break;
    }
    case Reading::kMeasured:
      keep_measured(reread);
      break;
  }
  return reread;
}

Result<Traversals> trace_reread(Reading reading, const Frame& frame, float rope_width_px,
                                const TraceConfig& config) {
  const cv::Rect box = bounding_box(frame);
  if (reading == Reading::kAsGiven || box.empty()) return trace(frame, config);
  if (const int times = reduction_of(frame, box); times > 1) {
    const Reduced reduced(frame, box, times);
    auto result =
        trace_reread(reading, reduced.frame(), rope_width_px / static_cast<float>(times), config);
    if (result) reduced.restore(*result);
    return result;
  }
  const Reread reread = reread_as(reading, frame, box, rope_width_px);
  cv::Mat instances = instances_in(frame, reread.window.part);
  if (!instances.empty()) {
    cv::resize(instances, instances, reread.mask.size(), 0, 0, cv::INTER_NEAREST);
  }
  auto result = trace(
      frame_of(reread.mask, reread.depth_m, instances, reread.window.camera(frame.intrinsics)),
      config);
  if (!result) return result;
  reread.window.restore(*result, {frame.width, frame.height});
  const auto as_given = [&](float width_px) {
    return std::max(kLeastWidthPx, width_px - reread.grown_px);
  };
  result->rope_width_px = as_given(result->rope_width_px);
  for (Path& path : result->ranked) path.width_px = as_given(path.width_px);
  return result;
}

// Pixels that a reading of so many has.
double pixels_of(Reading reading, double pixels) {
  if (reading == Reading::kHalved) return 0.25 * pixels;
  return reading == Reading::kDoubled ? 4 * pixels : pixels;
}

// As many of `readings`, in their order, as all together have no more pixels than may be read
// again.
void keep_affordable(std::vector<Reading>& readings, const Frame& frame) {
  const auto pixels = static_cast<double>(bounding_box(frame).area());
  double sum = 0;
  std::erase_if(readings, [&](Reading reading) {
    const double with = sum + pixels_of(reading, pixels);
    if (with > kMostRereadPixels) return true;
    sum = with;
    return false;
  });
}

}  // namespace

std::vector<Reading> further_readings(const Frame& frame, float rope_width_px) {
  std::vector<Reading> readings{Reading::kHalved, Reading::kEroded, Reading::kDilated};
  std::size_t unmeasured = 0;
  for (std::size_t i = 0; i < frame.mask.size(); ++i) {
    if (frame.mask[i] > 127 && !geometry::measured(frame.depth_m[i])) ++unmeasured;
  }
  const float least = kLeastUnmeasured * rope_width_px * rope_width_px;
  if (static_cast<float>(unmeasured) >= least) readings.push_back(Reading::kMeasured);
  if (rope_width_px <= kThickPx) readings.push_back(Reading::kDoubled);
  keep_affordable(readings, frame);
  return readings;
}

Result<Traversals> trace_as(Reading reading, const Frame& frame, float rope_width_px,
                            const TraceConfig& config) {
  return guard::guarded("path",
                        [&] { return trace_reread(reading, frame, rope_width_px, config); });
}

}  // namespace flowdlo::path
