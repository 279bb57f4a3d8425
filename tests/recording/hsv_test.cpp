#include "recording/hsv.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "mat/mat_image.hpp"

namespace flowdlo::recording {
namespace {

using support::Color;

TEST(Hsv, OfEveryColourIsOpenCVs) {
  cv::Mat colors(256, 256, CV_8UC3);
  cv::Mat hsv;
  int others = 0;
  for (int blue = 0; blue < 256; ++blue) {
    for (int green = 0; green < 256; ++green) {
      for (int red = 0; red < 256; ++red) {
        colors.at<cv::Vec3b>(green, red) = cv::Vec3i(blue, green, red);
      }
    }
    cv::cvtColor(colors, hsv, cv::COLOR_BGR2HSV);
    const auto picture = mat::image_of<Color>(colors);
    for (std::size_t i = 0; i < picture.total(); ++i) {
      const auto ours = hsv_of(picture.data()[i]);
      const auto& theirs = hsv.ptr<cv::Vec3b>()[i];
      others += ours != std::array<int, 3>{theirs[0], theirs[1], theirs[2]} ? 1 : 0;
    }
  }
  EXPECT_EQ(others, 0);
}

TEST(HsvMask, HueMayGoThroughRed) {
  support::Picture image({3, 1});
  image.at(0, 0) = {0, 0, 255};   // hue 0
  image.at(0, 1) = {40, 0, 255};  // hue 175
  image.at(0, 2) = {255, 0, 0};   // hue 120
  const auto red = hsv_mask(image, {{170, 100, 100}, {10, 255, 255}});
  EXPECT_EQ(red.at(0, 0), 255);
  EXPECT_EQ(red.at(0, 1), 255);
  EXPECT_EQ(red.at(0, 2), 0);
  const auto blue = hsv_mask(image, {{110, 100, 100}, {130, 255, 255}});
  EXPECT_EQ(blue.at(0, 0), 0);
  EXPECT_EQ(blue.at(0, 2), 255);
}

}  // namespace
}  // namespace flowdlo::recording
