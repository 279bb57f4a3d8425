// Canvas: a mask drawn by hand, with or without depth, as a frame; and what to ask of a path.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "path/path.hpp"

namespace flowdlo::test {

using Eigen::Vector2f;
using Curve = std::vector<cv::Point>;

inline constexpr double kPi = std::numbers::pi;

class Canvas {
 public:
  explicit Canvas(int width = 640, int height = 480)
      : mask(cv::Mat::zeros(height, width, CV_8U)),
        depth_m(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0.0F) {}

  Canvas& stroke(const Curve& curve, int width_px) {
    cv::polylines(mask, std::vector<Curve>{curve}, false, cv::Scalar(255), width_px);
    return *this;
  }
  Canvas& erase(const cv::Rect& box) {
    mask(box) = 0;
    return *this;
  }
  /// The depth under `curve`, `width_px` wide.
  Canvas& depth(const Curve& curve, int width_px, float value_m) {
    cv::Mat plane(mask.size(), CV_32F, depth_m.data());
    cv::polylines(plane, std::vector<Curve>{curve}, false, cv::Scalar(value_m), width_px);
    return *this;
  }

  [[nodiscard]] Frame frame() const {
    const auto size = static_cast<float>(mask.cols);
    return {mask.cols,
            mask.rows,
            {size, size, 0.5F * size, 0.5F * static_cast<float>(mask.rows)},
            depth_m,
            {mask.ptr<std::uint8_t>(), mask.total()},
            {}};
  }

  cv::Mat mask;
  std::vector<float> depth_m;
};

/// A curve given by a function of t in [0, 1].
template <class Function>
Curve curve_of(Function function, int count = 400) {
  Curve curve;
  for (int i = 0; i <= count; ++i) {
    const auto [x, y] = function(static_cast<double>(i) / count);
    curve.emplace_back(static_cast<int>(std::lround(x)), static_cast<int>(std::lround(y)));
  }
  return curve;
}

/// `curve` with points about a pixel apart, not only at its corners.
inline Curve dense(const Curve& curve) {
  Curve points;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    const cv::Point step = curve[i] - curve[i - 1];
    const int count = std::max({1, std::abs(step.x), std::abs(step.y)});
    for (int k = 0; k < count; ++k) points.push_back(curve[i - 1] + step * k / count);
  }
  points.push_back(curve.back());
  return points;
}

inline float distance_to(const std::vector<Vector2f>& points, const cv::Point& p) {
  float least = std::numeric_limits<float>::max();
  for (const Vector2f& q : points) {
    least =
        std::min(least, (q - Vector2f(static_cast<float>(p.x), static_cast<float>(p.y))).norm());
  }
  return least;
}

/// Discrete Frechet distance of path and curve, the better of both directions: small only when
/// the path goes where the curve goes, in its order.
inline float frechet(const path::Path& path, const Curve& curve) {
  const auto one_way = [&](bool reversed) {
    const std::size_t n = curve.size();
    std::vector<float> before(n);
    std::vector<float> now(n);
    const std::size_t count = path.points_px.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Vector2f& p = path.points_px[reversed ? count - 1 - i : i];
      for (std::size_t j = 0; j < n; ++j) {
        const Vector2f q(static_cast<float>(curve[j].x), static_cast<float>(curve[j].y));
        float reach = i == 0 && j == 0 ? 0 : std::numeric_limits<float>::max();
        if (i > 0) reach = std::min(reach, before[j]);
        if (j > 0) reach = std::min(reach, now[j - 1]);
        if (i > 0 && j > 0) reach = std::min(reach, before[j - 1]);
        now[j] = std::max(reach, (p - q).norm());
      }
      std::swap(before, now);
    }
    return before.back();
  };
  return std::min(one_way(false), one_way(true));
}

/// Every contract of a path: finite, distinct, inside the image, flags of the same length.
inline bool sound(const path::Path& path, const Frame& frame) {
  if (path.points_px.size() < 2 || path.bridged.size() != path.points_px.size()) return false;
  for (std::size_t i = 0; i < path.points_px.size(); ++i) {
    const Vector2f& p = path.points_px[i];
    if (!p.allFinite() || p.x() < 0 || p.y() < 0) return false;
    if (p.x() > static_cast<float>(frame.width - 1)) return false;
    if (p.y() > static_cast<float>(frame.height - 1)) return false;
    if (i > 0 && p == path.points_px[i - 1]) return false;
  }
  return std::isfinite(path.score);
}

}  // namespace flowdlo::test
