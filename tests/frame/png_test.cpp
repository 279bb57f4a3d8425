#include "frame/png.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstddef>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "mat/mat_png.hpp"
#include "support/peak_memory.hpp"

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
  auto bytes = mat::encode_png(gradient(type));
  EXPECT_TRUE(bytes);
  return *bytes;
}

void append_big_endian(std::vector<std::uint8_t>& bytes, std::size_t value) {
  for (const int shift : {24, 16, 8, 0}) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

/// `png` with a chunk of that type before its pixels.
std::vector<std::uint8_t> with_chunk(std::vector<std::uint8_t> png, const std::string& type,
                                     const std::vector<std::uint8_t>& data, int times = 1) {
  constexpr std::ptrdiff_t kHeaderEnd = 33;  // of the signature and IHDR
  std::vector<std::uint8_t> content(type.begin(), type.end());
  content.insert(content.end(), data.begin(), data.end());
  std::vector<std::uint8_t> chunk;
  append_big_endian(chunk, data.size());
  chunk.insert(chunk.end(), content.begin(), content.end());
  append_big_endian(chunk, crc32(0, content.data(), static_cast<uInt>(content.size())));
  std::vector<std::uint8_t> chunks;
  for (int i = 0; i < times; ++i) chunks.insert(chunks.end(), chunk.begin(), chunk.end());
  png.insert(png.begin() + kHeaderEnd, chunks.begin(), chunks.end());
  return png;
}

/// A chunk's data: `head`, then one letter `count` times, compressed.
std::vector<std::uint8_t> packed_text(const std::string& head, std::size_t count) {
  const std::vector<std::uint8_t> letters(count, 'a');
  std::vector<std::uint8_t> packed(compressBound(count));
  uLongf size = packed.size();
  compress2(packed.data(), &size, letters.data(), count, 9);
  packed.resize(size);
  packed.insert(packed.begin(), head.begin(), head.end());
  return packed;
}

std::string fault_of(const std::vector<std::uint8_t>& bytes) {
  const auto image = mat::decode_png(bytes, "a.png");
  if (image) return "";
  EXPECT_EQ(image.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(image.error().message, testing::StartsWith("a.png: "));
  return image.error().message;
}

TEST(Png, EveryKindReadsBackAsStored) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC3}) {
    const auto image = mat::decode_png(encoded(type), "a.png");
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

  const auto image = mat::decode_png(bytes, "a.png");

  ASSERT_TRUE(image) << image.error().message;
  ASSERT_EQ(image->type(), CV_8UC1);
  EXPECT_EQ(cv::norm(*image, stripes, cv::NORM_INF), 0);
}

TEST(Png, ImageOfFloatsIsNotWritten) {
  EXPECT_FALSE(mat::encode_png(cv::Mat::zeros(2, 2, CV_32FC1)));
  EXPECT_FALSE(mat::encode_png(cv::Mat()));
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

TEST(Png, TransparentGreyStaysGrey) {
  for (const int type : {CV_8UC1, CV_16UC1}) {
    const auto image = mat::decode_png(with_chunk(encoded(type), "tRNS", {0, 7}), "a.png");
    ASSERT_TRUE(image) << image.error().message;
    ASSERT_EQ(image->type(), type);
    EXPECT_EQ(cv::norm(*image, gradient(type), cv::NORM_INF), 0);
  }
}

TEST(Png, WhatIsNoPixelIsNotUnpacked) {
  constexpr std::size_t kUnpacked = 7900000;  // below libpng's own limit of 8 MB a chunk
  constexpr int kChunks = 30;
  const std::string text_head("k\0\0", 3);
  const std::string international_head("k\0\1\0\0\0", 6);
  for (const auto& [type, head] :
       {std::pair{"zTXt", text_head}, std::pair{"iTXt", international_head}}) {
    const auto bytes = with_chunk(encoded(CV_8UC1), type, packed_text(head, kUnpacked), kChunks);
    const double grown_mb = test::peak_growth_mb([&] {
      const auto image = mat::decode_png(bytes, "a.png");
      ASSERT_TRUE(image) << image.error().message;
      EXPECT_EQ(cv::norm(*image, gradient(CV_8UC1), cv::NORM_INF), 0);
    });
    EXPECT_LT(grown_mb, 5) << type << ": a file of " << bytes.size() << " bytes";
  }
}

TEST(Png, SidesBeyondTheLimitAreRefused) {
  const auto bytes = mat::encode_png(cv::Mat::zeros(1, 4097, CV_8UC1));
  ASSERT_TRUE(bytes);
  EXPECT_THAT(fault_of(*bytes), HasSubstr("expected sides of 1 to 4096 px, got 4097 x 1"));
}

}  // namespace
}  // namespace flowdlo::frame
