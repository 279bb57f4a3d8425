#include "eval/space_view.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace flowdlo::eval {
namespace {

constexpr double kTilt_rad = 0.9;   // from the camera's view towards the table's
constexpr double kTurn_rad = 0.35;  // about the upright
constexpr double kFill = 0.8;       // of the panel
constexpr double kLeast_m = 0.02;
constexpr double kFarthest_px = 20000;

}  // namespace

SpaceView::SpaceView(const Centerline& subject, cv::Size panel) : panel_(panel) {
  for (const Point3& p : subject) {
    middle_ += cv::Point3d(p.x, p.y, p.z) * (1.0 / kNodes);
  }
  cv::Point2d low(1e9, 1e9);
  cv::Point2d high(-1e9, -1e9);
  for (const Point3& p : subject) {
    const cv::Point2d q = turned(p);
    low = {std::min(low.x, q.x), std::min(low.y, q.y)};
    high = {std::max(high.x, q.x), std::max(high.y, q.y)};
  }
  offset_ = 0.5 * (low + high);
  zoom_ = kFill * std::min(panel.width / std::max(high.x - low.x, kLeast_m),
                           panel.height / std::max(high.y - low.y, kLeast_m));
}

cv::Point2d SpaceView::turned(const Point3& point) const {
  const double x = static_cast<double>(point.x) - middle_.x;
  const double y = static_cast<double>(point.y) - middle_.y;
  const double z = static_cast<double>(point.z) - middle_.z;
  const double across = x * std::cos(kTurn_rad) - z * std::sin(kTurn_rad);
  const double deep = x * std::sin(kTurn_rad) + z * std::cos(kTurn_rad);
  return {across, y * std::cos(kTilt_rad) - deep * std::sin(kTilt_rad)};
}

cv::Point SpaceView::at(const Point3& point) const {
  const cv::Point2d q = zoom_ * (turned(point) - offset_);
  const auto pixel = [](double value) {
    return static_cast<int>(std::lround(std::clamp(value, -kFarthest_px, kFarthest_px)));
  };
  return {pixel(q.x + panel_.width / 2.0), pixel(q.y + panel_.height / 2.0)};
}

void SpaceView::draw(const Centerline& nodes, const cv::Scalar& color, int width,
                     cv::Mat& panel) const {
  std::vector<cv::Point> line;
  for (const Point3& node : nodes) line.push_back(at(node));
  cv::polylines(panel, line, false, color, width, cv::LINE_AA);
  cv::circle(panel, line.front(), 4 + width, color, 1, cv::LINE_AA);
}

}  // namespace flowdlo::eval
