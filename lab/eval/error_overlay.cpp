#include "eval/error_overlay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "mat/mat_png.hpp"

namespace flowdlo::eval {
namespace {

constexpr int kPlotWidth = 480;
constexpr int kSize = 1000;  // of the longer side of the image
constexpr float kFar_px = 1e5F;
const cv::Scalar kTruth{60, 230, 60};
const cv::Scalar kEstimate{40, 40, 255};
const cv::Scalar kUnsupported{40, 230, 255};
const cv::Scalar kBare{150, 60, 120};
const cv::Scalar kText{235, 235, 235};
constexpr int kLegend = 32;        // height
constexpr int kLeastWidth = 1240;  // that takes the legend

cv::Scalar color_of(std::span<const std::uint8_t> support, std::size_t node) {
  return support.empty() || support[node] != 0 ? kEstimate : kUnsupported;
}

/// The image, or the depth as grey where there is no colour.
cv::Mat picture_of(const Frame& frame) {
  cv::Mat picture(frame.height, frame.width, CV_8UC3, cv::Scalar::all(90));
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u) {
      const auto i = static_cast<std::size_t>(v) * frame.width + u;
      const bool rope = frame.mask[i] > 127;
      cv::Vec3b& pixel = picture.at<cv::Vec3b>(v, u);
      for (int c = 0; c < 3 && !frame.color_bgr.empty(); ++c) {
        pixel[c] = frame.color_bgr[3 * i + static_cast<std::size_t>(c)];
      }
      const bool bare = rope && !(frame.depth_m[i] > 1e-6F);
      pixel = rope ? pixel * 0.75 : pixel * 0.35;
      if (bare) pixel = pixel * 0.5 + cv::Vec3b(90, 0, 60);  // mask without depth
    }
  }
  return picture;
}

void draw_depths(const Centerline& truth, const Centerline& nodes,
                 std::span<const std::uint8_t> support, cv::Mat& plot) {
  float low = truth[0].z;
  float high = low;
  for (const Point3& p : truth) {
    low = std::min(low, p.z);
    high = std::max(high, p.z);
  }
  const float margin = 0.2F * (high - low) + 0.005F;
  const auto at = [&](std::size_t i, float z) {
    const float y = (z - low + margin) / (high - low + 2 * margin) * static_cast<float>(plot.rows);
    return cv::Point(static_cast<int>(i) * kPlotWidth / kNodes + 5,
                     static_cast<int>(std::clamp(y, -100.0F, 5000.0F)));
  };
  for (std::size_t i = 0; i < kNodes; ++i) {
    cv::circle(plot, at(i, truth[i].z), 3, kTruth, cv::FILLED);
    cv::circle(plot, at(i, nodes[i].z), 3, color_of(support, i), cv::FILLED);
  }
}

/// What the colours mean, below both pictures.
void draw_legend(std::span<const std::uint8_t> support, double mean_m, cv::Mat& band) {
  constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
  constexpr double kScale = 0.45;
  int x = 12;
  const auto write = [&](const std::string& text, const cv::Scalar& color) {
    cv::putText(band, text, {x, 22}, kFont, kScale, color, 1, cv::LINE_AA);
    int below = 0;
    x += cv::getTextSize(text, kFont, kScale, 1, &below).width + 22;
  };
  const auto entry = [&](const std::string& text, const cv::Scalar& color) {
    cv::circle(band, {x + 5, 17}, 5, color, cv::FILLED, cv::LINE_AA);
    x += 18;
    write(text, kText);
  };
  entry("truth", kTruth);
  entry("estimate", kEstimate);
  if (!support.empty()) entry("estimate, not measured", kUnsupported);
  entry("mask without depth", kBare);
  write("white: from node to node", kText);
  write("ring: node 0", kText);
  write(fmt::format("mean index error {:.2f} cm", 100 * mean_m), kText);
}

double mean_distance_m(const Centerline& truth, const Centerline& nodes) {
  double sum = 0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    sum += std::hypot(static_cast<double>(truth[i].x - nodes[i].x),
                      static_cast<double>(truth[i].y - nodes[i].y),
                      static_cast<double>(truth[i].z - nodes[i].z));
  }
  return sum / kNodes;
}

}  // namespace

Result<std::vector<std::uint8_t>> error_overlay_png(const Frame& frame, const Centerline& truth,
                                                    const Centerline& nodes,
                                                    std::span<const std::uint8_t> support) {
  const auto project = [&](const Point3& p) {
    const Intrinsics& camera = frame.intrinsics;
    const float z = std::max(p.z, 1e-3F);
    return cv::Point2f(std::clamp(camera.fx * p.x / z + camera.cx, -kFar_px, kFar_px),
                       std::clamp(camera.fy * p.y / z + camera.cy, -kFar_px, kFar_px));
  };
  std::vector<cv::Point2f> corners;
  for (const Point3& p : truth) corners.push_back(project(p));
  cv::Rect box = cv::boundingRect(corners);
  box = cv::Rect(box.x - 25, box.y - 25, box.width + 50, box.height + 50) &
        cv::Rect(0, 0, frame.width, frame.height);
  if (box.empty()) box = cv::Rect(0, 0, frame.width, frame.height);
  const float zoom =
      static_cast<float>(kSize) / static_cast<float>(std::max(box.width, box.height));
  cv::Mat picture;
  cv::resize(picture_of(frame)(box), picture, {}, static_cast<double>(zoom),
             static_cast<double>(zoom), zoom > 1 ? cv::INTER_NEAREST : cv::INTER_AREA);
  const auto at = [&](const Point3& p) {
    const cv::Point2f q = project(p);
    return cv::Point(static_cast<int>((q.x - static_cast<float>(box.x) + 0.5F) * zoom),
                     static_cast<int>((q.y - static_cast<float>(box.y) + 0.5F) * zoom));
  };
  for (std::size_t i = 0; i < kNodes; ++i) {
    cv::line(picture, at(truth[i]), at(nodes[i]), {255, 255, 255}, 1, cv::LINE_AA);
    cv::circle(picture, at(truth[i]), i == 0 ? 8 : 2, kTruth, i == 0 ? 2 : cv::FILLED);
    cv::circle(picture, at(nodes[i]), i == 0 ? 11 : 2, color_of(support, i),
               i == 0 ? 2 : cv::FILLED);
    if (i + 1 == kNodes) continue;
    cv::line(picture, at(truth[i]), at(truth[i + 1]), kTruth, 1, cv::LINE_AA);
    cv::line(picture, at(nodes[i]), at(nodes[i + 1]), kEstimate, 1, cv::LINE_AA);
  }
  cv::Mat both(picture.rows + kLegend, std::max(kLeastWidth, picture.cols + kPlotWidth), CV_8UC3,
               cv::Scalar::all(25));
  picture.copyTo(both(cv::Rect(0, 0, picture.cols, picture.rows)));
  cv::Mat plot = both(cv::Rect(picture.cols, 0, kPlotWidth, picture.rows));
  draw_depths(truth, nodes, support, plot);
  cv::putText(plot, "depth of each node, nearer above", {12, 20}, cv::FONT_HERSHEY_SIMPLEX, 0.45,
              kText, 1, cv::LINE_AA);
  cv::Mat legend = both.rowRange(picture.rows, both.rows);
  draw_legend(support, mean_distance_m(truth, nodes), legend);
  return mat::encode_png(both);
}

}  // namespace flowdlo::eval
