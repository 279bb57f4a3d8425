// Strided images of every kind as the views that a Frame holds, and what is refused.
#include "c_api/images.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

namespace flowdlo::c_api {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

constexpr int kWidth = 4;
constexpr int kHeight = 3;

/// 4 x 3 px: depth 0, 1, ..., mask 100, 101, ..., colour 0, 1, ...
struct Pixels {
  std::vector<float> depth = std::vector<float>(kWidth * kHeight);
  std::vector<std::uint8_t> mask = std::vector<std::uint8_t>(kWidth * kHeight);
  std::vector<std::uint8_t> color = std::vector<std::uint8_t>(kWidth * kHeight * 3);

  Pixels() {
    std::iota(depth.begin(), depth.end(), 0.0F);
    std::iota(mask.begin(), mask.end(), std::uint8_t{100});
    std::iota(color.begin(), color.end(), std::uint8_t{0});
  }

  [[nodiscard]] flowdlo_frame frame() const {
    flowdlo_frame out{};
    out.struct_size = sizeof(out);
    out.depth = {depth.data(), 0, 0, FLOWDLO_PIXEL_F32, 0};
    out.mask = {mask.data(), 0, 0, FLOWDLO_PIXEL_U8, 0};
    out.color = {color.data(), 0, 0, FLOWDLO_PIXEL_BGR8, 0};
    out.depth_scale_m = 0.001;
    out.width = kWidth;
    out.height = kHeight;
    out.fx = out.fy = 100;
    out.cx = 1.5F;
    out.cy = 1;
    return out;
  }
};

std::string fault_of(const flowdlo_frame& frame) {
  Copies copies;
  const auto made = frame_of(frame, copies);
  return made ? "none" : made.error().message;
}

TEST(Images, PackedOnesAreNotCopied) {
  const Pixels pixels;
  Copies copies;
  const auto frame = frame_of(pixels.frame(), copies);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->depth_m.data(), pixels.depth.data());
  EXPECT_EQ(frame->mask.data(), pixels.mask.data());
  EXPECT_EQ(frame->color_bgr.data(), pixels.color.data());
  EXPECT_EQ(frame->depth_m.size(), 12);
  EXPECT_EQ(frame->color_bgr.size(), 36);
  EXPECT_TRUE(copies.depth_m.empty() && copies.mask.empty() && copies.color_bgr.empty());
}

TEST(Images, UnitsOfDepthBecomeMetres) {
  const Pixels pixels;
  const std::vector<std::uint16_t> units = {0, 1, 2, 3, 4, 5, 6, 7, 8, 500, 1234, 65535};
  flowdlo_frame given = pixels.frame();
  given.depth = {units.data(), 0, 0, FLOWDLO_PIXEL_U16, 0};
  given.depth_scale_m = 0.00025;
  Copies copies;
  const auto frame = frame_of(given, copies);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->depth_m[0], 0.0F);
  EXPECT_EQ(frame->depth_m[10], static_cast<float>(1234 * 0.00025));
  EXPECT_EQ(frame->depth_m[11], static_cast<float>(65535 * 0.00025));
}

TEST(Images, RowsMayBePadded) {
  const Pixels pixels;
  std::vector<std::byte> padded(kHeight * 24);  // rows of 16 bytes
  for (int v = 0; v < kHeight; ++v) {
    std::memcpy(&padded[static_cast<std::size_t>(v) * 24], &pixels.depth[v * kWidth], 16);
  }
  flowdlo_frame given = pixels.frame();
  given.depth.data = padded.data();
  given.depth.row_bytes = 24;
  Copies copies;
  const auto frame = frame_of(given, copies);
  ASSERT_TRUE(frame);
  EXPECT_THAT(frame->depth_m, ElementsAreArray(pixels.depth));
}

TEST(Images, DepthMayLieAtAnyAddress) {
  const Pixels pixels;
  std::vector<std::byte> bytes(sizeof(float) * pixels.depth.size() + 1);
  std::memcpy(bytes.data() + 1, pixels.depth.data(), bytes.size() - 1);
  flowdlo_frame given = pixels.frame();
  given.depth.data = bytes.data() + 1;
  Copies copies;
  const auto frame = frame_of(given, copies);
  ASSERT_TRUE(frame);
  EXPECT_THAT(frame->depth_m, ElementsAreArray(pixels.depth));
}

TEST(Images, AMaskMayBeOneChannelOfAnImage) {
  const Pixels pixels;
  flowdlo_frame given = pixels.frame();
  given.mask = {pixels.color.data() + 1, 0, 3, FLOWDLO_PIXEL_U8, 0};
  Copies copies;
  const auto frame = frame_of(given, copies);
  ASSERT_TRUE(frame);
  EXPECT_THAT(frame->mask, ElementsAre(1, 4, 7, 10, 13, 16, 19, 22, 25, 28, 31, 34));
}

TEST(Images, RowsAndPixelsMayRunBackwards) {
  const Pixels pixels;
  flowdlo_frame given = pixels.frame();
  given.mask.data = pixels.mask.data() + 11;
  given.mask.row_bytes = -kWidth;
  given.mask.pixel_bytes = -1;
  Copies copies;
  const auto frame = frame_of(given, copies);
  ASSERT_TRUE(frame);
  EXPECT_THAT(frame->mask, ElementsAre(111, 110, 109, 108, 107, 106, 105, 104, 103, 102, 101, 100));
}

TEST(Images, RgbBecomesBgr) {
  const Pixels pixels;
  flowdlo_frame given = pixels.frame();
  given.color.pixel = FLOWDLO_PIXEL_RGB8;
  Copies copies;
  const auto frame = frame_of(given, copies);
  ASSERT_TRUE(frame);
  EXPECT_THAT(frame->color_bgr.first(6), ElementsAre(2, 1, 0, 5, 4, 3));
}

TEST(Images, ColorMayHaveAFourthChannel) {
  const Pixels pixels;
  std::vector<std::uint8_t> bgra(kWidth * kHeight * 4);
  std::iota(bgra.begin(), bgra.end(), std::uint8_t{0});
  flowdlo_frame given = pixels.frame();
  given.color = {bgra.data(), 0, 4, FLOWDLO_PIXEL_BGR8, 0};
  Copies copies;
  const auto frame = frame_of(given, copies);
  ASSERT_TRUE(frame);
  EXPECT_THAT(frame->color_bgr.first(6), ElementsAre(0, 1, 2, 4, 5, 6));
}

TEST(Images, ColorMayBeLeftOut) {
  const Pixels pixels;
  flowdlo_frame given = pixels.frame();
  given.color = {};
  Copies copies;
  const auto frame = frame_of(given, copies);
  ASSERT_TRUE(frame);
  EXPECT_TRUE(frame->color_bgr.empty());
}

TEST(Images, ARegionOfInterestMovesThePrincipalPoint) {
  const Pixels pixels;
  flowdlo_frame given = pixels.frame();
  given.roi_u = 1;
  given.roi_v = 1;
  given.roi_width = 2;
  given.roi_height = 2;
  Copies copies;
  const auto frame = frame_of(given, copies);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->width, 2);
  EXPECT_EQ(frame->height, 2);
  EXPECT_EQ(frame->intrinsics.cx, 0.5F);
  EXPECT_EQ(frame->intrinsics.cy, 0.0F);
  EXPECT_EQ(frame->intrinsics.fx, 100.0F);
  EXPECT_THAT(frame->depth_m, ElementsAre(5, 6, 9, 10));
  EXPECT_THAT(frame->mask, ElementsAre(105, 106, 109, 110));
  EXPECT_THAT(frame->color_bgr, ElementsAre(15, 16, 17, 18, 19, 20, 27, 28, 29, 30, 31, 32));
}

TEST(Images, WholeRowsOfARegionAreNotCopied) {
  const Pixels pixels;
  flowdlo_frame given = pixels.frame();
  given.roi_v = 1;
  given.roi_width = kWidth;
  given.roi_height = 2;
  Copies copies;
  const auto frame = frame_of(given, copies);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->depth_m.data(), pixels.depth.data() + kWidth);
  EXPECT_EQ(frame->depth_m.size(), 8);
}

TEST(Images, ARegionBeyondTheImageIsRefused) {
  constexpr int kMost = std::numeric_limits<int>::max();
  const Pixels pixels;
  const int regions[][4] = {{0, 0, 5, 3},  {0, 0, 4, 4},  {1, 0, 4, 3},        {-1, 0, 2, 2},
                            {0, 3, 1, 1},  {0, 0, -1, 2}, {1, 1, 0, 0},        {kMost, 0, kMost, 1},
                            {0, -1, 1, 1}, {0, 0, 2, 0},  {2, 2, kMost, kMost}};
  for (const auto& [u, v, width, height] : regions) {
    flowdlo_frame given = pixels.frame();
    given.roi_u = u;
    given.roi_v = v;
    given.roi_width = width;
    given.roi_height = height;
    EXPECT_THAT(fault_of(given), HasSubstr("flowdlo_frame.roi: expected a region within 4 x 3 px"));
  }
}

TEST(Images, SizesThatAreNoneAreRefused) {
  const Pixels pixels;
  for (const int side : {0, -1, 65537, std::numeric_limits<int>::min()}) {
    flowdlo_frame given = pixels.frame();
    given.width = given.height = side;
    EXPECT_THAT(fault_of(given), HasSubstr("flowdlo_frame.width: expected 1 to 65536 px, got"));
    EXPECT_THAT(fault_of(given), HasSubstr("flowdlo_frame.height: expected 1 to 65536 px, got"));
  }
}

TEST(Images, StridesThatOverlapOrOverflowAreRefused) {
  constexpr auto kLeast = std::numeric_limits<std::ptrdiff_t>::min();
  constexpr auto kMost = std::numeric_limits<std::ptrdiff_t>::max();
  const Pixels pixels;
  for (const std::ptrdiff_t row : {std::ptrdiff_t{4}, std::ptrdiff_t{15}, kLeast, kMost}) {
    flowdlo_frame given = pixels.frame();
    given.depth.row_bytes = row;
    EXPECT_THAT(fault_of(given),
                HasSubstr("flowdlo_frame.depth.row_bytes: expected at least the 16 bytes"));
  }
  for (const std::ptrdiff_t pixel : {std::ptrdiff_t{2}, std::ptrdiff_t{-3}, kLeast, kMost}) {
    flowdlo_frame given = pixels.frame();
    given.depth.pixel_bytes = pixel;
    EXPECT_THAT(fault_of(given), HasSubstr("flowdlo_frame.depth.pixel_bytes: expected 4 to"));
  }
}

TEST(Images, EveryFaultIsListed) {
  const Pixels pixels;
  flowdlo_frame given = pixels.frame();
  given.depth.pixel = FLOWDLO_PIXEL_U8;
  given.mask.data = nullptr;
  given.color.reserved = 77;
  const std::string faults = fault_of(given);
  EXPECT_THAT(faults, HasSubstr("flowdlo_frame.depth.pixel: expected FLOWDLO_PIXEL_F32"));
  EXPECT_THAT(faults, HasSubstr("flowdlo_frame.mask.data: expected an image, got NULL"));
  EXPECT_THAT(faults, HasSubstr("flowdlo_frame.color.reserved: expected 0, got 77"));
  given.color.pixel = 77;
  EXPECT_THAT(fault_of(given), HasSubstr("flowdlo_frame.color.pixel: expected FLOWDLO_PIXEL_BGR8"));
}

TEST(Images, AScaleThatIsNoneIsRefused) {
  const Pixels pixels;
  const std::vector<std::uint16_t> units(12, 500);
  for (const double scale : {0.0, -0.001, 1.5, std::numeric_limits<double>::quiet_NaN()}) {
    flowdlo_frame given = pixels.frame();
    given.depth = {units.data(), 0, 0, FLOWDLO_PIXEL_U16, 0};
    given.depth_scale_m = scale;
    EXPECT_THAT(fault_of(given), HasSubstr("flowdlo_frame.depth_scale_m: expected metres a unit"));
  }
}

}  // namespace
}  // namespace flowdlo::c_api
