// MatPng: PNG images as OpenCV's images.
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

#include "frame/png.hpp"

namespace flowdlo::mat {

/// As frame::decode_png.
[[nodiscard]] inline Result<cv::Mat> decode_png(std::span<const std::uint8_t> bytes,
                                                const std::string& who) {
  auto image = frame::decode_png(bytes, who);
  if (!image) return image.error();
  const frame::PngFormat& format = image->format();
  const int type = CV_MAKETYPE(format.bits == 16 ? CV_16U : CV_8U, format.channels);
  return cv::Mat(format.height, format.width, type, image->values<std::uint8_t>().data()).clone();
}

/// As frame::encode_png.
[[nodiscard]] inline Result<std::vector<std::uint8_t>> encode_png(const cv::Mat& image) {
  const int bits = image.depth() == CV_8U ? 8 : image.depth() == CV_16U ? 16 : 0;
  return frame::encode_png({image.cols, image.rows, image.channels(), bits}, image.data,
                           image.empty() ? 0 : image.step[0]);
}

}  // namespace flowdlo::mat
