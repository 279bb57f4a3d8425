#include "mask_overlay.hpp"

#include <opencv2/imgproc.hpp>

#include "overlay_style.hpp"

namespace flowdlo::tools {
namespace {

constexpr double kDimmed = 0.45;  ///< of a pixel's grey beside the mask
const cv::Scalar kPaper(40, 40, 40);
const cv::Scalar kRope(200, 200, 200);

}  // namespace

cv::Mat draw_mask_overlay(const Frame& frame) {
  const cv::Size size(frame.width, frame.height);
  const cv::Mat mask =
      cv::Mat(size, CV_8UC1, const_cast<std::uint8_t*>(frame.mask.data())) > 127;  // only read
  cv::Mat picture(size, CV_8UC3, kPaper);
  if (frame.color_bgr.empty()) {
    picture.setTo(kRope, mask);
  } else {
    const cv::Mat color(size, CV_8UC3, const_cast<std::uint8_t*>(frame.color_bgr.data()));
    cv::Mat grey;
    cv::cvtColor(color, grey, cv::COLOR_BGR2GRAY);
    cv::cvtColor(grey, picture, cv::COLOR_GRAY2BGR);
    picture.convertTo(picture, -1, kDimmed);
    color.copyTo(picture, mask);
  }
  cv::Mat grown;
  cv::dilate(mask, grown, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
  picture.setTo(kSupportedColor, grown & ~mask);
  return picture;
}

}  // namespace flowdlo::tools
