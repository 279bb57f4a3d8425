#include "frame/png.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace flowdlo::frame {
namespace {

using testing::HasSubstr;

cv::Mat gradient(int type) {
  cv::Mat image(12, 16, type);
  cv::RNG random(7);
  random.fill(image, cv::RNG::UNIFORM, 0, 65535);
  return image;
}

std::vector<std::uint8_t> encoded(int type) {
  auto bytes = encode_png(gradient(type));
  EXPECT_TRUE(bytes);
  return *bytes;
}

std::string fault_of(const std::vector<std::uint8_t>& bytes) {
  const auto image = decode_png(bytes, "a.png");
  if (image) return "";
  EXPECT_EQ(image.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(image.error().message, testing::StartsWith("a.png: "));
  return image.error().message;
}

TEST(Png, EveryKindReadsBackAsStored) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC3}) {
    const auto image = decode_png(encoded(type), "a.png");
    ASSERT_TRUE(image) << image.error().message;
    ASSERT_EQ(image->type(), type);
    EXPECT_EQ(cv::norm(*image, gradient(type), cv::NORM_INF), 0);
  }
}

TEST(Png, OpenCvReadsWhatIsWritten) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC3}) {
    const cv::Mat image = cv::imdecode(encoded(type), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(image.type(), type);
    EXPECT_EQ(cv::norm(image, gradient(type), cv::NORM_INF), 0);
  }
}

TEST(Png, OneBitAPixelBecomesEight) {
  std::vector<std::uint8_t> bytes;
  const cv::Mat stripes = gradient(CV_8UC1) > 127;
  cv::imencode(".png", stripes, bytes, {cv::IMWRITE_PNG_BILEVEL, 1});

  const auto image = decode_png(bytes, "a.png");

  ASSERT_TRUE(image) << image.error().message;
  ASSERT_EQ(image->type(), CV_8UC1);
  EXPECT_EQ(cv::norm(*image, stripes, cv::NORM_INF), 0);
}

TEST(Png, ImageOfFloatsIsNotWritten) {
  EXPECT_FALSE(encode_png(cv::Mat::zeros(2, 2, CV_32FC1)));
  EXPECT_FALSE(encode_png(cv::Mat()));
}

TEST(Png, CutShortAnywhereIsRefused) {
  const auto whole = encoded(CV_16UC1);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto end = whole.begin() + static_cast<std::ptrdiff_t>(size);
    EXPECT_FALSE(fault_of({whole.begin(), end}).empty()) << size << " of " << whole.size();
  }
}

TEST(Png, FlippedBitAnywhereIsFound) {
  const auto whole = encoded(CV_8UC1);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    auto flipped = whole;
    flipped[at] ^= 0x10;
    EXPECT_FALSE(fault_of(flipped).empty()) << "byte " << at;
  }
}

TEST(Png, OtherFilesAreNamedAsSuch) {
  const std::vector<std::uint8_t> jpeg = {0xFF, 0xD8, 0xFF, 0xE0, 0, 16, 'J', 'F', 'I', 'F'};
  EXPECT_THAT(fault_of(jpeg), HasSubstr("expected a PNG image, got another kind of file"));
}

TEST(Png, SidesBeyondTheLimitAreRefused) {
  const auto bytes = encode_png(cv::Mat::zeros(1, 4097, CV_8UC1));
  ASSERT_TRUE(bytes);
  EXPECT_THAT(fault_of(*bytes), HasSubstr("expected sides of 1 to 4096 px, got 4097 x 1"));
}

}  // namespace
}  // namespace flowdlo::frame
