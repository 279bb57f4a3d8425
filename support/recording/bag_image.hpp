// BagImage: image messages as the pixels of a frame.
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <string>

#include "flowdlo/result.hpp"
#include "recording/bag.hpp"

namespace flowdlo::recording {

/// Inclusive bounds in OpenCV's units: hue 0..179, saturation and value 0..255. A lower bound of
/// the hue above the upper one goes through red.
struct HsvRange {
  std::array<int, 3> low{};
  std::array<int, 3> high{};
};

/// [h, w] 8-bit BGR of rgb8, bgr8, rgba8, bgra8, mono8 (and 8UC1, 8UC3, 8UC4, in BGR order), or of
/// a JPEG or PNG. Fails with kBadInput, naming `who`.
[[nodiscard]] Result<cv::Mat> color_image(const ImageMessage& message, const std::string& who);

/// [h, w] float metres of 16UC1 (mm) or 32FC1 (m), raw, as PNG, or as the PNG of compressedDepth; 0
/// or not finite: none.
[[nodiscard]] Result<cv::Mat> depth_image(const ImageMessage& message, const std::string& who);

/// [h, w] 8-bit, the rope over 127, of mono8 or 8UC1, raw or as JPEG or PNG.
[[nodiscard]] Result<cv::Mat> mask_image(const ImageMessage& message, const std::string& who);

/// [h, w] 8-bit, 255 where the colour is within `range`.
[[nodiscard]] cv::Mat hsv_mask(const cv::Mat& color_bgr, const HsvRange& range);

}  // namespace flowdlo::recording
