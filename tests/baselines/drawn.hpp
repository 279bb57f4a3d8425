// Masks and frames drawn for the baselines.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "baselines/observation.hpp"

namespace flowdlo::baselines::test {

inline constexpr int kWidth = 320;
inline constexpr int kHeight = 240;

inline cv::Mat blank() { return cv::Mat::zeros(kHeight, kWidth, CV_8U); }

/// A line of `width` px through `points`.
inline cv::Mat drawn(const std::vector<cv::Point>& points, int width, cv::Mat mask = blank()) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    cv::line(mask, points[i - 1], points[i], 255, width);
  }
  return mask;
}

/// Points about 3 px apart of a loop that crosses itself once, in a right angle: in from the left,
/// round, and out upwards.
inline std::vector<cv::Point> loop() {
  std::vector<cv::Point> points;
  for (int i = 0; i <= 40; ++i) points.emplace_back(40 + 4 * i, 170);
  for (int i = 0; i <= 60; ++i) {
    const double angle = 1.5707963 - i * 1.5 * 3.1415927 / 60;
    points.emplace_back(200 + cvRound(60 * std::cos(angle)), 110 + cvRound(60 * std::sin(angle)));
  }
  for (int i = 1; i <= 30; ++i) points.emplace_back(140, 110 + 4 * i);
  return points;
}

/// A frame of this mask half a metre from the camera.
inline Observation observation(const cv::Mat& mask, float depth_m = 0.5F) {
  Observation seen;
  FrameFolder& folder = seen.folder;
  folder.width = mask.cols;
  folder.height = mask.rows;
  folder.intrinsics = {300, 300, 160, 120};
  folder.mask.assign(mask.begin<std::uint8_t>(), mask.end<std::uint8_t>());
  folder.depth_m.assign(folder.mask.size(), depth_m);
  return seen;
}

/// Largest distance of a point of `path` from the polyline's points.
template <class Path>
double farthest_px(const Path& path, const std::vector<cv::Point>& points) {
  double most = 0;
  for (const auto& p : path) {
    double nearest = 1e9;
    for (const cv::Point& q : points) {
      nearest = std::min(
          nearest, std::hypot(static_cast<double>(p.x) - q.x, static_cast<double>(p.y) - q.y));
    }
    most = std::max(most, nearest);
  }
  return most;
}

}  // namespace flowdlo::baselines::test
