// The overlay's colours (BGR) and sizes. Teal and orange stay apart for the colour-blind.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <opencv2/core/types.hpp>

namespace flowdlo::tools {

inline const cv::Scalar kSupportedColor(196, 212, 32);
inline const cv::Scalar kBridgedColor(0, 140, 255);
inline const cv::Scalar kRimColor(24, 16, 12);
inline const cv::Scalar kMaskOutlineColor(235, 235, 235);
inline const cv::Scalar kTextColor(240, 240, 240);

/// Of one of several ropes, by its index; they begin again after nine.
inline const cv::Scalar& rope_color(std::size_t rope) {
  static const std::array<cv::Scalar, 9> colors{
      cv::Scalar(196, 212, 32), {60, 160, 255},  {255, 130, 90},  {90, 230, 90},  {230, 110, 230},
      {60, 230, 245},           {255, 235, 150}, {130, 130, 255}, {190, 190, 190}};
  return colors[rope % colors.size()];
}

/// Sizes in pixels of the picture; they grow with it.
struct OverlayStyle {
  explicit OverlayStyle(int picture_width_px)
      : scale(std::max(0.75F, static_cast<float>(picture_width_px) / 640.0F)),
        line_px(rounded(2.6F * scale)),
        rim_px(rounded(1.0F * scale)),
        marker_radius_px(rounded(8.5F * scale)),
        outline_px(rounded(0.6F * scale)),
        text_scale(0.43F * std::pow(scale, 0.75F)) {}

  static int rounded(float size_px) { return std::max(1, static_cast<int>(std::lround(size_px))); }

  float scale;
  int line_px;
  int rim_px;
  int marker_radius_px;
  int outline_px;
  float text_scale;  ///< of the legend: it may grow more slowly than the picture
};

}  // namespace flowdlo::tools
