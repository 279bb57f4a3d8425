#include "path/seams.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "path/square_brush.hpp"
#include "path/thinning.hpp"
#include "path/valleys.hpp"

namespace flowdlo::path {
namespace {

constexpr float kSlitWidths = 0.35F;   // slits of the mask up to this wide belong to a seam
constexpr float kWideShare = 0.56F;    // half a square that fits in two strands and not in one
constexpr float kReachWidths = 0.6F;   // and how far from there a seam may run
constexpr float kExtentWidths = 4.5F;  // what holds a seam extends this far
constexpr float kNoiseLow = 2.0F;      // a seam's least depth in sigmas,
constexpr float kRadiiLow = 0.12F;     // and in radii of the rope;
constexpr float kNoiseHigh = 3.5F;     // half of it is at least this deep
constexpr float kRadiiHigh = 0.3F;
constexpr float kShortestWidths = 6.0F;  // what a flat crossing leaves is shorter
constexpr float kSpurWidths = 0.7F;      // a branch that leads nowhere is shorter
constexpr float kRungWidths = 1.3F;      // and so is a shallow one from seam to seam
constexpr float kTangentWidths = 0.5F;   // what tells a line's direction at its tip
constexpr float kRunOutWidths = 0.6F;    // from there to the mask's edge
constexpr float kSliverWidths = 0.3F;    // cut off between a seam and a slit

// Where `closed` is wider than one strand, for long enough to hold a seam; and what is near to
// that. Empty when nothing is.
cv::Mat wide_parts(const cv::Mat& closed, const SeamScale& scale) {
  const int strand = static_cast<int>(std::ceil(kWideShare * scale.narrow_px));
  cv::Mat wide = eroded(closed, strand);
  if (cv::countNonZero(wide) == 0) return {};
  wide =
      dilated(dilated(wide, strand), static_cast<int>(std::ceil(kReachWidths * scale.narrow_px)));
  cv::Mat labels;
  cv::Mat stats;
  cv::Mat centroids;
  const int count = cv::connectedComponentsWithStats(wide, labels, stats, centroids, 8, CV_32S);
  std::vector<std::uint8_t> keep(static_cast<std::size_t>(count), 0);
  bool any = false;
  for (int i = 1; i < count; ++i) {
    const auto extent = static_cast<float>(
        std::max(stats.at<int>(i, cv::CC_STAT_WIDTH), stats.at<int>(i, cv::CC_STAT_HEIGHT)));
    keep[i] = extent >= kExtentWidths * scale.width_px ? 1 : 0;
    any = any || keep[i] != 0;
  }
  if (!any) return {};
  for (int v = 0; v < wide.rows; ++v) {
    const int* label = labels.ptr<int>(v);
    std::uint8_t* row = wide.ptr<std::uint8_t>(v);
    for (int u = 0; u < wide.cols; ++u) row[u] = keep[label[u]];
  }
  return wide;
}

// The band of pixels that seams run in: of the closed mask's wide parts, what is slit or valley.
// False when there is no valley.
bool keep_valleys(const cv::Mat& mask, const cv::Mat& wide, const cv::Mat& valley_m, float low_m,
                  cv::Mat& band) {
  bool any = false;
  for (int v = 0; v < mask.rows; ++v) {
    const std::uint8_t* lit = mask.ptr<std::uint8_t>(v);
    const std::uint8_t* open = wide.ptr<std::uint8_t>(v);
    const float* depth = valley_m.ptr<float>(v);
    std::uint8_t* to = band.ptr<std::uint8_t>(v);
    for (int u = 0; u < mask.cols; ++u) {
      const bool valley = lit[u] != 0 && depth[u] > low_m;
      if (open[u] == 0 || (lit[u] != 0 && !valley)) to[u] = 0;
      any = any || (valley && to[u] != 0);
    }
  }
  return any;
}

int around(const cv::Mat& lines, int u, int v) {
  int count = 0;
  for (int dv = -1; dv <= 1; ++dv) {
    for (int du = -1; du <= 1; ++du) count += lines.at<std::uint8_t>(v + dv, u + du) != 0 ? 1 : 0;
  }
  return count - 1;
}

struct Branch {
  int length = 0;
  int tips = 0;
  int inside = 0;     // of the mask, not of a slit
  float depth_m = 0;  // summed over those
};

// The stretches of `lines` between tips and forks, numbered from 1 in `labels`.
std::vector<Branch> branches_of(const cv::Mat& lines, const cv::Mat& mask, const cv::Mat& valley_m,
                                cv::Mat& labels) {
  cv::Mat open = lines.clone();
  cv::Mat tips = cv::Mat::zeros(lines.size(), CV_8U);
  for (int v = 1; v + 1 < lines.rows; ++v) {
    for (int u = 1; u + 1 < lines.cols; ++u) {
      if (lines.at<std::uint8_t>(v, u) == 0) continue;
      const int degree = around(lines, u, v);
      if (degree > 2) open.at<std::uint8_t>(v, u) = 0;
      tips.at<std::uint8_t>(v, u) = degree < 2 ? 1 : 0;
    }
  }
  const int count = cv::connectedComponents(open, labels, 8, CV_32S);
  std::vector<Branch> branches(static_cast<std::size_t>(count));
  for (int v = 1; v + 1 < lines.rows; ++v) {
    for (int u = 1; u + 1 < lines.cols; ++u) {
      const int label = labels.at<int>(v, u);
      if (label == 0) continue;
      Branch& branch = branches[static_cast<std::size_t>(label)];
      ++branch.length;
      branch.tips += tips.at<std::uint8_t>(v, u);
      if (mask.at<std::uint8_t>(v, u) == 0) continue;
      ++branch.inside;
      branch.depth_m += valley_m.at<float>(v, u);
    }
  }
  return branches;
}

// Takes from `lines` branches that lead nowhere and are shorter than `spur_px`, and those shorter
// than `rung_px` that are less deep than `high_m` in the mean.
void prune(cv::Mat& lines, const cv::Mat& mask, const cv::Mat& valley_m, float high_m,
           float spur_px, float rung_px) {
  cv::Mat labels;
  const std::vector<Branch> branches = branches_of(lines, mask, valley_m, labels);
  for (int v = 1; v + 1 < lines.rows; ++v) {
    for (int u = 1; u + 1 < lines.cols; ++u) {
      const int label = labels.at<int>(v, u);
      if (label == 0) continue;
      const Branch& branch = branches[static_cast<std::size_t>(label)];
      const auto length = static_cast<float>(branch.length);
      const bool shallow =
          length < rung_px && branch.depth_m < high_m * static_cast<float>(branch.inside);
      if (shallow || (branch.tips == 1 && length < spur_px)) lines.at<std::uint8_t>(v, u) = 0;
    }
  }
  lines = thin(lines);
}

// The line's pixel some steps from its tip.
cv::Point back_from(const cv::Mat& lines, cv::Point tip, int steps) {
  cv::Point before = tip;
  cv::Point at = tip;
  for (int i = 0; i < steps; ++i) {
    cv::Point next = at;
    for (int dv = -1; dv <= 1; ++dv) {
      for (int du = -1; du <= 1; ++du) {
        const cv::Point p = at + cv::Point(du, dv);
        const cv::Point off = p - before;
        const bool away = std::max(std::abs(off.x), std::abs(off.y)) > 1 || before == at;
        if (p != at && p != before && away && lines.at<std::uint8_t>(p) != 0) next = p;
      }
    }
    if (next == at) break;
    before = at;
    at = next;
  }
  return at;
}

// Thinning ends a line before the mask does: tips run on to its edge where that is near.
void run_out(cv::Mat& lines, const cv::Mat& mask, float width_px) {
  std::vector<cv::Point> added;
  for (int v = 1; v + 1 < lines.rows; ++v) {
    for (int u = 1; u + 1 < lines.cols; ++u) {
      const cv::Point tip(u, v);
      if (lines.at<std::uint8_t>(tip) == 0 || mask.at<std::uint8_t>(tip) == 0) continue;
      if (around(lines, u, v) != 1) continue;
      const int steps = std::max(3, static_cast<int>(kTangentWidths * width_px));
      const cv::Point2f along = tip - back_from(lines, tip, steps);
      const float length = std::hypot(along.x, along.y);
      const int reach = static_cast<int>(kRunOutWidths * width_px);
      std::vector<cv::Point> way;
      for (int k = 1; k <= reach && length > 0; ++k) {
        const cv::Point p = cv::Point2f(tip) + static_cast<float>(k) / length * along;
        if (p.x < 1 || p.y < 1 || p.x + 1 >= lines.cols || p.y + 1 >= lines.rows) break;
        if (mask.at<std::uint8_t>(p) == 0) {
          added.insert(added.end(), way.begin(), way.end());
          break;
        }
        way.push_back(p);
      }
    }
  }
  for (const cv::Point& p : added) lines.at<std::uint8_t>(p) = 1;
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

// Adds the mask's slits that the seams run through, and what the seams cut off the mask that is no
// strand: thin pieces beside those slits.
void add_slits(const cv::Mat& mask, const cv::Mat& closed, float narrow_px, cv::Mat& seams) {
  const int half = std::max(1, static_cast<int>(0.5F * kSliverWidths * narrow_px));
  cv::Mat rest = mask.clone();
  rest.setTo(0, seams);
  const cv::Mat thick = dilated(eroded(rest, half), half);
  const cv::Mat near = dilated(seams, half);
  seams |= near & ((rest & (1 - thick)) | (closed & (1 - mask)));
}

// The seams of a mask that has `wide` parts; `closed` is the mask without its slits.
cv::Mat seams_in(const ValleyView& view, const cv::Mat& wide, float narrow_px, const Frame& frame) {
  const Valleys valleys = measure_valleys(view, frame);
  if (valleys.radius_m <= 0) return {};
  const float low_m = std::max(kNoiseLow * valleys.noise_m, kRadiiLow * valleys.radius_m);
  const float high_m = std::max(kNoiseHigh * valleys.noise_m, kRadiiHigh * valleys.radius_m);
  cv::Mat band = view.closed.clone();
  if (!keep_valleys(view.mask, wide, valleys.depth_m, low_m, band)) return {};
  cv::Mat lines = thin(band);
  const float spur_px = kSpurWidths * view.width_px;
  prune(lines, view.mask, valleys.depth_m, high_m, spur_px, 0);
  prune(lines, view.mask, valleys.depth_m, high_m, spur_px, kRungWidths * view.width_px);
  run_out(lines, view.mask, view.width_px);
  cv::Mat seams =
      long_and_deep(lines, view.mask, valleys.depth_m, high_m, kShortestWidths * view.width_px);
  if (!seams.empty()) add_slits(view.mask, view.closed, narrow_px, seams);
  return seams;
}

}  // namespace

cv::Mat find_seams(const cv::Mat& mask, const SeamScale& scale, const Frame& frame) {
  const int slit = std::max(1, static_cast<int>(std::lround(0.5F * kSlitWidths * scale.narrow_px)));
  const cv::Mat closed = eroded(dilated(mask, slit), slit);
  const cv::Mat wide = wide_parts(closed, scale);
  if (wide.empty()) return {};
  const int margin = valley_margin(scale.width_px);
  const cv::Rect inner = cv::boundingRect(wide);
  const cv::Rect box = cv::Rect(inner.x - margin, inner.y - margin, inner.width + 2 * margin,
                                inner.height + 2 * margin) &
                       cv::Rect(0, 0, mask.cols, mask.rows);
  const ValleyView view{mask(box), closed(box), inner - box.tl(), scale.offset_px + box.tl(),
                        scale.width_px};
  const cv::Mat found = seams_in(view, wide(box), scale.narrow_px, frame);
  if (found.empty()) return {};
  cv::Mat seams = cv::Mat::zeros(mask.size(), CV_8U);
  found.copyTo(seams(box));
  return seams;
}

}  // namespace flowdlo::path
