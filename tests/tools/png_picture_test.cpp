#include "png_picture.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "mat/mat_image.hpp"
#include "mat/mat_png.hpp"

namespace flowdlo::support {
namespace {

TEST(Picture, GreyOfEveryColourIsOpenCVs) {
  cv::Mat colors(256, 256, CV_8UC3);
  cv::Mat greys;
  int others = 0;
  for (int blue = 0; blue < 256; ++blue) {
    for (int green = 0; green < 256; ++green) {
      for (int red = 0; red < 256; ++red) {
        colors.at<cv::Vec3b>(green, red) = cv::Vec3i(blue, green, red);
      }
    }
    cv::cvtColor(colors, greys, cv::COLOR_BGR2GRAY);
    const auto picture = mat::image_of<Color>(colors);
    for (std::size_t i = 0; i < picture.total(); ++i) {
      others += grey_of(picture.data()[i]) != greys.data[i] ? 1 : 0;
    }
  }
  EXPECT_EQ(others, 0);
}

cv::Mat noise(int type) {
  cv::Mat image(24, 31, type);
  cv::RNG random(7);
  random.fill(image, cv::RNG::UNIFORM, 0, CV_MAT_DEPTH(type) == CV_16U ? 65536 : 256);
  return image;
}

frame::PngImage png_of(const cv::Mat& image) {
  const auto bytes = mat::encode_png(image);
  EXPECT_TRUE(bytes);
  return *frame::decode_png(*bytes, "noise");
}

/// As OpenCV converts it: to 8 bits, then to 3 channels or to 1.
cv::Mat converted(const cv::Mat& image, int channels) {
  cv::Mat bytes;
  image.convertTo(bytes, CV_8U, image.depth() == CV_16U ? 1.0 / 256 : 1.0);
  if (bytes.channels() == channels) return bytes;
  const bool to_grey = channels == 1;
  const int code = bytes.channels() == 1   ? cv::COLOR_GRAY2BGR
                   : bytes.channels() == 3 ? cv::COLOR_BGR2GRAY
                   : to_grey               ? cv::COLOR_BGRA2GRAY
                                           : cv::COLOR_BGRA2BGR;
  cv::cvtColor(bytes, bytes, code);
  return bytes;
}

TEST(PngPicture, OfEveryFormatIsWhatOpenCVMakesOfIt) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC3, CV_16UC4}) {
    const cv::Mat image = noise(type);
    const auto png = png_of(image);
    EXPECT_EQ(cv::norm(mat::mat_over(picture_of(png)), converted(image, 3), cv::NORM_INF), 0)
        << type;
    EXPECT_EQ(cv::norm(mat::mat_over(grey_image_of(png)), converted(image, 1), cv::NORM_INF), 0)
        << type;
  }
}

TEST(PngPicture, PartOfAPictureIsWrittenAndReadAgain) {
  const auto whole = mat::image_of<Color>(noise(CV_8UC3));
  const auto part = whole.part({3, 5, 17, 11});
  const auto bytes = encode_png(part);
  ASSERT_TRUE(bytes);
  const auto read = picture_of(*frame::decode_png(*bytes, "part"));
  EXPECT_EQ(read.size(), part.size());
  EXPECT_EQ(cv::norm(mat::mat_over(read), mat::mat_over(part), cv::NORM_INF), 0);

  const image::Mask mask = mat::image_of<std::uint8_t>(noise(CV_8UC1)).part({2, 2, 20, 9});
  const auto mask_bytes = encode_png(mask);
  ASSERT_TRUE(mask_bytes);
  const auto png = frame::decode_png(*mask_bytes, "mask");
  EXPECT_EQ(png->format(), (frame::PngFormat{20, 9, 1, 8}));
}

}  // namespace
}  // namespace flowdlo::support
