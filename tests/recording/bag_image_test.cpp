#include "recording/bag_image.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "mat/mat_image.hpp"
#include "recording/drawn_recording.hpp"

namespace flowdlo::recording {
namespace {

using test::packed_depth_message;
using test::packed_message;
using test::raw_message;
using testing::HasSubstr;

const cv::Vec3b kBgr{200, 60, 10};

cv::Mat bgr_image() { return {8, 12, CV_8UC3, cv::Scalar(kBgr[0], kBgr[1], kBgr[2])}; }

cv::Mat converted(const cv::Mat& image, int code) {
  cv::Mat result;
  cv::cvtColor(image, result, code);
  return result;
}

cv::Vec3b color_of(const Result<support::Picture>& image) {
  EXPECT_TRUE(image) << image.error().message;
  const auto color = image ? image->at(3, 5) : support::Color{};
  return {color[0], color[1], color[2]};
}

float depth_of(const Result<image::Image<float>>& image) {
  EXPECT_TRUE(image) << image.error().message;
  return image ? image->at(3, 5) : -1;
}

TEST(BagImage, ColourOfEveryEncodingIsBgr) {
  const cv::Mat bgr = bgr_image();
  EXPECT_EQ(color_of(color_image(raw_message(bgr, "bgr8"), "c")), kBgr);
  const auto rgb = converted(bgr, cv::COLOR_BGR2RGB);
  EXPECT_EQ(color_of(color_image(raw_message(rgb, "rgb8"), "c")), kBgr);
  const auto rgba = converted(bgr, cv::COLOR_BGR2RGBA);
  EXPECT_EQ(color_of(color_image(raw_message(rgba, "rgba8"), "c")), kBgr);
  const auto bgra = converted(bgr, cv::COLOR_BGR2BGRA);
  EXPECT_EQ(color_of(color_image(raw_message(bgra, "bgra8"), "c")), kBgr);
  const cv::Mat grey(8, 12, CV_8UC1, cv::Scalar(77));
  EXPECT_EQ(color_of(color_image(raw_message(grey, "mono8"), "c")), cv::Vec3b(77, 77, 77));
}

TEST(BagImage, CompressedColourIsBgr) {
  const auto png = packed_message(bgr_image(), ".png", "rgb8; png compressed bgr8");
  EXPECT_EQ(color_of(color_image(png, "c")), kBgr);
  const auto jpeg = packed_message(bgr_image(), ".jpg", "rgb8; jpeg compressed bgr8");
  const auto color = color_of(color_image(jpeg, "c"));
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(color[i], kBgr[i], 6);
}

TEST(BagImage, RowsMayBePadded) {
  auto message = raw_message(bgr_image(), "bgr8");
  std::vector<std::uint8_t> padded;
  for (std::size_t v = 0; v < 8; ++v) {
    padded.insert(padded.end(), message.data.begin() + 36 * v, message.data.begin() + 36 * (v + 1));
    padded.insert(padded.end(), 4, 255);
  }
  message.data = padded;
  message.step = 40;
  const auto image = color_image(message, "c");
  ASSERT_TRUE(image);
  EXPECT_EQ(cv::norm(mat::mat_over(*image), bgr_image(), cv::NORM_INF), 0);
}

TEST(BagImage, DepthIsInMetres) {
  const cv::Mat millimetres(8, 12, CV_16UC1, cv::Scalar(1234));
  EXPECT_FLOAT_EQ(depth_of(depth_image(raw_message(millimetres, "16UC1"), "d")), 1.234F);
  const cv::Mat metres(8, 12, CV_32FC1, cv::Scalar(0.75));
  EXPECT_FLOAT_EQ(depth_of(depth_image(raw_message(metres, "32FC1"), "d")), 0.75F);
}

TEST(BagImage, DepthMayBeBigEndian) {
  auto message = raw_message(cv::Mat(8, 12, CV_16UC1, cv::Scalar(1234)), "16UC1");
  for (std::size_t i = 0; i < message.data.size(); i += 2) {
    std::swap(message.data[i], message.data[i + 1]);
  }
  message.big_endian = true;
  EXPECT_FLOAT_EQ(depth_of(depth_image(message, "d")), 1.234F);
}

TEST(BagImage, CompressedDepthIsUnpacked) {
  const cv::Mat millimetres(8, 12, CV_16UC1, cv::Scalar(1234));
  for (const char* format : {"16UC1; compressedDepth", "16UC1; compressedDepth png"}) {
    EXPECT_FLOAT_EQ(depth_of(depth_image(packed_depth_message(millimetres, format), "d")), 1.234F);
  }
  EXPECT_FLOAT_EQ(depth_of(depth_image(packed_message(millimetres, ".png", "16UC1; png"), "d")),
                  1.234F);
}

TEST(BagImage, CompressedFloatsAreUnpacked) {
  const float a = 100;
  const float b = -20;
  cv::Mat values(8, 12, CV_16UC1, cv::Scalar(180));  // 100 / (180 + 20) = 0.5 m
  values.at<std::uint16_t>(0, 0) = 0;
  const auto depth =
      depth_image(packed_depth_message(values, "32FC1; compressedDepth png", a, b), "d");
  EXPECT_FLOAT_EQ(depth_of(depth), 0.5F);
  EXPECT_EQ(depth->at(0, 0), 0.0F) << "no depth stays none";
}

TEST(BagImage, UnknownEncodingNamesTheKnownOnes) {
  const auto color = color_image(raw_message(bgr_image(), "bayer_rggb8"), "bag: /color");
  ASSERT_FALSE(color);
  EXPECT_THAT(color.error().message, HasSubstr("bag: /color: expected an encoding of rgb8"));
  EXPECT_THAT(color.error().message, HasSubstr("\"bayer_rggb8\""));
  EXPECT_FALSE(depth_image(raw_message(bgr_image(), "bgr8"), "d"));
  EXPECT_FALSE(mask_image(raw_message(bgr_image(), "bgr8"), "m"));
  const auto rvl =
      packed_depth_message(cv::Mat(8, 12, CV_16UC1, cv::Scalar(1)), "16UC1; compressedDepth rvl");
  EXPECT_FALSE(depth_image(rvl, "d"));
}

TEST(BagImage, SizeThatTheBytesDoNotFillIsRefused) {
  for (const int fault : {0, 1, 2, 3}) {
    auto message = raw_message(bgr_image(), "bgr8");
    if (fault == 0) message.data.resize(message.data.size() - 1);
    if (fault == 1) message.step = 35;
    if (fault == 2) message.width = 0;
    if (fault == 3) message.height = 4000000000U;
    EXPECT_FALSE(color_image(message, "c")) << fault;
  }
}

TEST(BagImage, BytesThatAreNoPictureAreRefused) {
  auto message = packed_message(bgr_image(), ".png", "png");
  message.data.resize(20);
  const auto cut = color_image(message, "c");
  ASSERT_FALSE(cut);
  EXPECT_THAT(cut.error().message, HasSubstr("expected a JPEG or PNG"));
  message.data.clear();
  EXPECT_FALSE(color_image(message, "c"));
  message.format = "16UC1; compressedDepth";
  EXPECT_FALSE(depth_image(message, "d"));
  EXPECT_FALSE(depth_image(packed_message(bgr_image(), ".png", "16UC1; png"), "d"));
}

TEST(BagImage, MaskOfZerosAndOnesIsRefused) {
  const auto mask = mask_image(raw_message(cv::Mat(8, 12, CV_8UC1, cv::Scalar(1)), "mono8"), "m");
  ASSERT_FALSE(mask);
  EXPECT_THAT(mask.error().message, HasSubstr("multiply by 255"));
}

TEST(BagImage, JpegCutShortIsRefused) {
  auto jpeg = packed_message(bgr_image(), ".jpg", "rgb8; jpeg compressed bgr8");
  jpeg.data.resize(jpeg.data.size() * 3 / 4);

  const auto color = color_image(jpeg, "c");

  ASSERT_FALSE(color);
  EXPECT_THAT(color.error().message, HasSubstr("expected a JPEG or PNG"));
}

}  // namespace
}  // namespace flowdlo::recording
