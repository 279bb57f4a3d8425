#include "path/seams.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "path/thinning.hpp"

namespace flowdlo::path {
namespace {

constexpr float kSlitWidths = 0.35F;   // slits of the mask up to this wide belong to a seam
constexpr float kWideShare = 0.62F;    // distance to the edge, widths, that one strand never has
constexpr float kReachWidths = 0.6F;   // and how far from there a seam may run
constexpr float kSmoothWidths = 0.1F;  // sigma of the depths' smoothing
constexpr float kProbeWidths = 0.3F;   // from a valley to its sides
constexpr int kDirections = 8;
constexpr float kSlope = 0.75F;      // metres of depth a metre sideways; more is a step,
constexpr float kStepWeight = 2.0F;  // which counts against a valley
constexpr float kNoiseLow = 3.0F;    // a seam's least depth in sigmas,
constexpr float kRadiiLow = 0.12F;   // and in radii of the rope;
constexpr float kNoiseHigh = 5.0F;   // half of it is at least this deep
constexpr float kRadiiHigh = 0.3F;
constexpr float kShortestWidths = 6.0F;  // what a flat crossing leaves is shorter
constexpr float kSliverWidths = 0.3F;    // cut off between a seam and a slit
constexpr float kLeastShare = 0.05F;     // of valid depths under the smoothing
constexpr float kAbsent_m = 1e6F;        // stands for a depth that is missing

struct Depths {
  cv::Mat smooth_m;   // [h, w] f32, kAbsent_m outside of the mask
  float noise_m = 0;  // of a single depth
  float usual_m = 0;
};

cv::Mat square(int half) { return cv::Mat::ones(2 * half + 1, 2 * half + 1, CV_8U); }

// Erosion that takes what lies outside of the image for empty.
void erode(const cv::Mat& from, cv::Mat& to, const cv::Mat& brush) {
  cv::erode(from, to, brush, {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
}

float median_of(std::vector<float>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Depths inside of the mask, 0 where there are none.
cv::Mat masked_depths(const cv::Mat& mask, cv::Point offset_px, const Frame& frame) {
  cv::Mat depth = cv::Mat::zeros(mask.size(), CV_32F);
  const int left = std::max(0, -offset_px.x);
  const int right = std::min(mask.cols, frame.width - offset_px.x);
  for (int v = 0; v < mask.rows; ++v) {
    const int image_v = v + offset_px.y;
    if (image_v < 0 || image_v >= frame.height) continue;
    const std::uint8_t* lit = mask.ptr<std::uint8_t>(v);
    const float* from = frame.depth_m.data() + static_cast<std::size_t>(image_v) * frame.width;
    float* to = depth.ptr<float>(v);
    for (int u = left; u < right; ++u) {
      const float z = from[u + offset_px.x];
      if (lit[u] != 0 && z > 1e-6F && z < kAbsent_m) to[u] = z;
    }
  }
  return depth;
}

// Noise from second differences: a slope has none, and a rope's roundness next to none.
void measure_noise(const cv::Mat& depth, Depths& depths) {
  constexpr float kSigmas = 0.6745F * 2.4495F;  // of a median of |a - 2 b + c|
  std::vector<float> bends;
  std::vector<float> values;
  for (int v = 0; v < depth.rows; v += 3) {
    const float* row = depth.ptr<float>(v);
    for (int u = 1; u + 1 < depth.cols; u += 2) {
      if (row[u - 1] <= 0 || row[u] <= 0 || row[u + 1] <= 0) continue;
      bends.push_back(std::abs(row[u - 1] - 2 * row[u] + row[u + 1]));
      values.push_back(row[u]);
    }
  }
  depths.noise_m = median_of(bends) / kSigmas;
  depths.usual_m = median_of(values);
}

Depths smooth_depths(const cv::Mat& mask, cv::Point offset_px, float sigma_px, const Frame& frame) {
  Depths depths;
  cv::Mat depth = masked_depths(mask, offset_px, frame);
  measure_noise(depth, depths);
  cv::Mat weight;
  cv::Mat(depth > 0).convertTo(weight, CV_32F, 1.0 / 255);
  cv::GaussianBlur(depth, depth, {}, sigma_px);
  cv::GaussianBlur(weight, weight, {}, sigma_px);
  depths.smooth_m = cv::Mat(mask.size(), CV_32F, cv::Scalar(kAbsent_m));
  for (int v = 0; v < mask.rows; ++v) {
    const std::uint8_t* lit = mask.ptr<std::uint8_t>(v);
    const float* sum = depth.ptr<float>(v);
    const float* share = weight.ptr<float>(v);
    float* to = depths.smooth_m.ptr<float>(v);
    for (int u = 0; u < mask.cols; ++u) {
      if (lit[u] != 0 && share[u] > kLeastShare) to[u] = sum[u] / share[u];
    }
  }
  return depths;
}

// How much deeper each pixel of `box` is than its sides, in the direction where that is most. Where
// one side is higher than the other by more than a slope explains, there is a step, no valley.
cv::Mat valleys_m(const cv::Mat& smooth_m, const cv::Rect& box, float reach_px, float slope_m) {
  cv::Mat most = cv::Mat::zeros(smooth_m.size(), CV_32F);
  for (int k = 0; k < kDirections; ++k) {
    const double angle = std::numbers::pi * k / kDirections;
    const int du = static_cast<int>(std::lround(reach_px * std::cos(angle)));
    const int dv = static_cast<int>(std::lround(reach_px * std::sin(angle)));
    const int top = std::max(box.y, dv);
    const int bottom = std::min(box.y + box.height, smooth_m.rows - dv);
    const int left = std::max(box.x, std::abs(du));
    const int right = std::min(box.x + box.width, smooth_m.cols - std::abs(du));
    for (int v = top; v < bottom; ++v) {
      const float* here = smooth_m.ptr<float>(v);
      const float* one = smooth_m.ptr<float>(v - dv) - du;
      const float* other = smooth_m.ptr<float>(v + dv) + du;
      float* to = most.ptr<float>(v);
      for (int u = left; u < right; ++u) {
        const float deeper = here[u] - 0.5F * (one[u] + other[u]);
        const float step = 0.5F * std::abs(one[u] - other[u]) - slope_m;
        to[u] = std::max(to[u], deeper - kStepWeight * std::max(0.0F, step));
      }
    }
  }
  return most;
}

// The band of pixels that seams run in: of the closed mask's wide parts, what is slit or valley.
// False when there is no valley.
bool keep_valleys(const cv::Mat& mask, const cv::Mat& wide, const cv::Mat& smooth_m,
                  const cv::Mat& valley_m, float low_m, cv::Mat& band) {
  bool any = false;
  for (int v = 0; v < mask.rows; ++v) {
    const std::uint8_t* lit = mask.ptr<std::uint8_t>(v);
    const std::uint8_t* open = wide.ptr<std::uint8_t>(v);
    const float* z = smooth_m.ptr<float>(v);
    const float* depth = valley_m.ptr<float>(v);
    std::uint8_t* to = band.ptr<std::uint8_t>(v);
    for (int u = 0; u < mask.cols; ++u) {
      const bool valley = lit[u] != 0 && z[u] < kAbsent_m && depth[u] > low_m;
      if (open[u] == 0 || (lit[u] != 0 && !valley)) to[u] = 0;
      any = any || (valley && to[u] != 0);
    }
  }
  return any;
}

// The lines of `lines` that are long and mostly deeper than `high_m`, made tight against diagonal
// neighbours; empty when none is.
cv::Mat long_and_deep(const cv::Mat& lines, const cv::Mat& mask, const cv::Mat& valley_m,
                      float high_m, float least_px) {
  cv::Mat labels;
  const int count = cv::connectedComponents(lines, labels, 8, CV_32S);
  std::vector<int> length(static_cast<std::size_t>(count), 0);
  std::vector<int> deep(static_cast<std::size_t>(count), 0);  // less those that are not
  for (int v = 0; v < mask.rows; ++v) {
    for (int u = 0; u < mask.cols; ++u) {
      const int line = labels.at<int>(v, u);
      if (line == 0) continue;
      ++length[line];
      if (mask.at<std::uint8_t>(v, u) != 0)
        deep[line] += valley_m.at<float>(v, u) > high_m ? 1 : -1;
    }
  }
  cv::Mat seams = cv::Mat::zeros(mask.size(), CV_8U);
  bool any = false;
  for (int v = 1; v + 1 < mask.rows; ++v) {
    for (int u = 1; u + 1 < mask.cols; ++u) {
      const int line = labels.at<int>(v, u);
      if (line == 0 || static_cast<float>(length[line]) < least_px || deep[line] < 0) continue;
      any = true;
      seams.at<std::uint8_t>(v, u) = 1;
      const bool left = labels.at<int>(v + 1, u - 1) == line && labels.at<int>(v, u - 1) != line;
      const bool right = labels.at<int>(v + 1, u + 1) == line && labels.at<int>(v, u + 1) != line;
      if ((left || right) && labels.at<int>(v + 1, u) != line) seams.at<std::uint8_t>(v + 1, u) = 1;
    }
  }
  return any ? seams : cv::Mat();
}

// Adds what the seams cut off the mask that is no strand: thin pieces beside the mask's slits.
void add_slivers(const cv::Mat& mask, float narrow_px, cv::Mat& seams) {
  const int half = static_cast<int>(0.5F * kSliverWidths * narrow_px);
  if (half < 1) return;
  const cv::Mat brush = square(half);
  cv::Mat near;
  cv::Mat rest = mask.clone();
  cv::Mat thick;
  rest.setTo(0, seams);
  erode(rest, thick, brush);
  cv::dilate(thick, thick, brush);
  cv::dilate(seams, near, brush);
  seams |= rest & near & (1 - thick);
}

}  // namespace

cv::Mat find_seams(const cv::Mat& mask, const SeamScale& scale, const Frame& frame) {
  const int slit = std::max(1, static_cast<int>(std::lround(0.5F * kSlitWidths * scale.narrow_px)));
  cv::Mat band;
  cv::dilate(mask, band, square(slit));
  erode(band, band, square(slit));
  cv::Mat distance_px;
  cv::distanceTransform(band, distance_px, cv::DIST_L2, 3);
  cv::Mat wide = distance_px > kWideShare * scale.narrow_px;
  if (cv::countNonZero(wide) == 0) return {};
  cv::dilate(wide, wide, square(static_cast<int>(std::ceil(kReachWidths * scale.narrow_px))));

  const float sigma_px = std::clamp(kSmoothWidths * scale.width_px, 0.8F, 4.0F);
  const Depths depths = smooth_depths(mask, scale.offset_px, sigma_px, frame);
  if (depths.usual_m <= 0) return {};
  const float m_per_px = depths.usual_m / std::max(1.0F, frame.intrinsics.fx);
  const float reach_px = std::max(2.0F, kProbeWidths * scale.width_px);
  const cv::Mat valley_m =
      valleys_m(depths.smooth_m, cv::boundingRect(wide), reach_px, kSlope * reach_px * m_per_px);
  const float radius_m = 0.5F * scale.width_px * m_per_px;
  const float noise_m = depths.noise_m / (2 * std::sqrt(std::numbers::pi_v<float>) * sigma_px);
  const float low_m = std::max(kNoiseLow * noise_m, kRadiiLow * radius_m);
  const float high_m = std::max(kNoiseHigh * noise_m, kRadiiHigh * radius_m);
  if (!keep_valleys(mask, wide, depths.smooth_m, valley_m, low_m, band)) return {};
  cv::Mat seams =
      long_and_deep(thin(band), mask, valley_m, high_m, kShortestWidths * scale.width_px);
  if (!seams.empty()) add_slivers(mask, scale.narrow_px, seams);
  return seams;
}

}  // namespace flowdlo::path
