// Canvas: a white picture to draw figures on.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <utility>
#include <vector>

#include "flowdlo/result.hpp"

namespace flowdlo::pictures {

/// Colours of the figures, BGR; those of the thesis' figures where it has some.
inline const cv::Scalar kBaselineColor{30, 130, 240};
inline const cv::Scalar kPriorColor{150, 150, 150};
inline const cv::Scalar kEstimateColor{180, 60, 60};

/// Of draw `index`; they repeat after four.
[[nodiscard]] cv::Scalar draw_color(std::size_t index);

/// What a legend says, in order.
using Legend = std::vector<std::pair<std::string, cv::Scalar>>;

/// Of pictures that show every draw, the estimate and TrackDLO-init beside what `first` names.
[[nodiscard]] Legend legend_of_draws(const std::string& first, const cv::Scalar& color);

class Canvas {
 public:
  Canvas(int width, int height);

  void write(const std::string& text, cv::Point at, double size = 0.42);
  /// Ends at `at.x`.
  void write_left_of(const std::string& text, cv::Point at, double size = 0.42);
  void write_centred(const std::string& text, cv::Point at, double size = 0.42);
  void legend(const Legend& entries, cv::Point at);
  void grid_line(cv::Point from, cv::Point to);

  [[nodiscard]] cv::Mat& picture() { return picture_; }
  /// A view of part of the picture: what is drawn beyond its border is cut off.
  [[nodiscard]] cv::Mat panel(const cv::Rect& place) { return picture_(place); }

  /// Fails with kInternal.
  [[nodiscard]] Result<std::vector<std::uint8_t>> png() const;

 private:
  cv::Mat picture_;
};

}  // namespace flowdlo::pictures
