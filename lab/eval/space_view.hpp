// SpaceView: centerlines in space, drawn obliquely from above into a panel.
#pragma once

#include <opencv2/core.hpp>

#include "flowdlo/centerline.hpp"

namespace flowdlo::eval {

class SpaceView {
 public:
  /// Shows what is near `subject`: turned so that its depths can be seen, as large as fits.
  SpaceView(const Centerline& subject, cv::Size panel);

  [[nodiscard]] cv::Point at(const Point3& point) const;

  /// A line through the nodes with a ring around the first.
  void draw(const Centerline& nodes, const cv::Scalar& color, int width, cv::Mat& panel) const;

 private:
  [[nodiscard]] cv::Point2d turned(const Point3& point) const;

  cv::Point3d middle_;
  cv::Point2d offset_;
  double zoom_ = 1;
  cv::Size panel_;
};

}  // namespace flowdlo::eval
