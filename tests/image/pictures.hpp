// Pictures: masks and images of all sorts, for holding functions of them against OpenCV's.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <opencv2/imgproc.hpp>

#include "mat/mat_image.hpp"

namespace flowdlo::image {

/// Masks of 0 and 1: strokes, discs, noise of three densities, all set, all empty; `number` tells
/// which, and its size.
inline cv::Mat some_mask(std::uint64_t number) {
  cv::RNG random(number + 1);
  const int width = random.uniform(1, 200);
  const int height = random.uniform(1, 150);
  cv::Mat mask = cv::Mat::zeros(height, width, CV_8U);
  const auto place = [&] { return cv::Point(random.uniform(0, width), random.uniform(0, height)); };
  const int kind = static_cast<int>(number % 7);
  if (kind == 0) mask = 1;
  for (int i = 0; kind == 1 && i < 8; ++i) {
    const cv::Point from = place();
    cv::line(mask, from, place(), cv::Scalar(1), random.uniform(1, 20));
  }
  for (int i = 0; kind == 2 && i < 6; ++i) {
    cv::circle(mask, place(), random.uniform(1, 40), cv::Scalar(1), i % 2 == 0 ? -1 : 2);
  }
  for (int i = 0; kind >= 3 && kind <= 5 && i < width * height; ++i) {
    mask.data[i] = random.uniform(0, 10) < 2 * kind - 3 ? 1 : 0;
  }
  return mask;
}

/// Values between 0 and 2.
inline cv::Mat some_values(const cv::Size& size, int type, std::uint64_t number) {
  cv::RNG random(number + 1);
  cv::Mat values(size, type);
  random.fill(values, cv::RNG::UNIFORM, 0, type == CV_8U ? 256 : 2);
  return values;
}

/// Whether both have the same size and bits.
inline testing::AssertionResult same_bits(const cv::Mat& own, const cv::Mat& opencv) {
  if (own.size() != opencv.size() || own.type() != opencv.type()) {
    return testing::AssertionFailure() << own.size() << " and " << opencv.size();
  }
  const std::size_t bytes = static_cast<std::size_t>(own.cols) * own.elemSize();
  for (int v = 0; v < own.rows; ++v) {
    if (std::memcmp(own.ptr(v), opencv.ptr(v), bytes) != 0) {
      return testing::AssertionFailure() << own.size() << " differ in row " << v << ", by "
                                         << cv::norm(own, opencv, cv::NORM_INF) << " at most";
    }
  }
  return testing::AssertionSuccess();
}

}  // namespace flowdlo::image
