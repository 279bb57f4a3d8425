#include "flowdlo/frame.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace flowdlo {
namespace {

using testing::HasSubstr;

struct Pixels {
  std::vector<float> depth_m = std::vector<float>(12, 0.5F);
  std::vector<std::uint8_t> mask = std::vector<std::uint8_t>(12, 255);
  std::vector<std::uint8_t> color_bgr;

  [[nodiscard]] Frame frame() const {
    return {4, 3, {100.0F, 100.0F, 2.0F, 1.5F}, depth_m, mask, color_bgr};
  }
};

std::string fault_of(const Frame& frame) {
  const auto valid = validate(frame);
  if (valid) return "";
  EXPECT_EQ(valid.error().code, ErrorCode::kBadInput);
  return valid.error().message;
}

TEST(Frame, IsValidWithoutColour) { EXPECT_EQ(fault_of(Pixels{}.frame()), ""); }

TEST(Frame, OfOnePixelIsValid) {
  const std::vector<float> depth_m(1, 0.5F);
  const std::vector<std::uint8_t> mask(1, 255);
  EXPECT_EQ(fault_of({1, 1, {1.0F, 1.0F, 0.0F, 0.0F}, depth_m, mask, {}}), "");
}

TEST(Frame, DepthOfAnotherSizeIsNamedWithBothSizes) {
  Pixels pixels;
  pixels.depth_m.resize(6);
  EXPECT_EQ(fault_of(pixels.frame()), "Frame.depth_m: expected 12 values (4 x 3), got 6");
}

TEST(Frame, MaskOfAnotherSizeIsNamedWithBothSizes) {
  Pixels pixels;
  pixels.mask.clear();
  EXPECT_EQ(fault_of(pixels.frame()), "Frame.mask: expected 12 values (4 x 3), got 0");
}

TEST(Frame, ColourMustHaveThreeChannelsWhenPresent) {
  Pixels pixels;
  pixels.color_bgr.resize(12);
  EXPECT_EQ(fault_of(pixels.frame()), "Frame.color_bgr: expected 36 values (4 x 3 x 3), got 12");
}

TEST(Frame, LabelsOfAnotherSizeAreNamedWithBothSizes) {
  const Pixels pixels;
  const std::vector<std::uint16_t> labels(12, 1);
  Frame frame = pixels.frame();
  frame.instances = labels;
  EXPECT_EQ(fault_of(frame), "");
  frame.instances = std::span(labels).first(5);
  EXPECT_EQ(fault_of(frame), "Frame.instances: expected 12 values (4 x 3), got 5");
}

TEST(Frame, SidesBeyondTheLimitAreRefused) {
  auto frame = Pixels{}.frame();
  frame.width = 4097;
  EXPECT_THAT(fault_of(frame), HasSubstr("Frame.width: expected 1 to 4096 px, got 4097"));
  frame.width = 0;
  EXPECT_THAT(fault_of(frame), HasSubstr("Frame.width: expected 1 to 4096 px, got 0"));
  frame.width = -4;
  EXPECT_THAT(fault_of(frame), HasSubstr("got -4"));
}

class UnusableFocalLength : public testing::TestWithParam<float> {};

TEST_P(UnusableFocalLength, IsRefused) {
  auto frame = Pixels{}.frame();
  frame.intrinsics.fx = GetParam();
  EXPECT_THAT(fault_of(frame), HasSubstr("Frame.intrinsics.fx: expected"));
  frame = Pixels{}.frame();
  frame.intrinsics.fy = GetParam();
  EXPECT_THAT(fault_of(frame), HasSubstr("Frame.intrinsics.fy: expected"));
}

INSTANTIATE_TEST_SUITE_P(Frame, UnusableFocalLength,
                         testing::Values(0.0F, -600.0F, 1.0e-30F, 1.0e30F,
                                         std::numeric_limits<float>::quiet_NaN(),
                                         std::numeric_limits<float>::infinity()));

TEST(Frame, PrincipalPointMustBeFinite) {
  auto frame = Pixels{}.frame();
  frame.intrinsics.cx = std::numeric_limits<float>::quiet_NaN();
  frame.intrinsics.cy = -std::numeric_limits<float>::infinity();
  const auto fault = fault_of(frame);
  EXPECT_THAT(fault, HasSubstr("Frame.intrinsics.cx"));
  EXPECT_THAT(fault, HasSubstr("Frame.intrinsics.cy"));
}

TEST(Frame, MillimetresThatAreTakenForMetresAreRefused) {
  Pixels pixels;
  pixels.depth_m.assign(12, 582);
  pixels.depth_m.front() = std::numeric_limits<float>::infinity();
  EXPECT_THAT(
      fault_of(pixels.frame()),
      AllOf(HasSubstr("Frame.depth_m: expected metres, below 100 where the mask is set, got 582"),
            HasSubstr("multiply millimetres by 0.001")));
}

TEST(Frame, FarThingsBesideTheRopeAndFewFarDepthsOnItAreNoOtherUnit) {
  Pixels pixels;
  pixels.depth_m.assign(12, 400);
  for (std::size_t p = 0; p < 6; ++p) pixels.depth_m[p] = 0.5F;
  EXPECT_EQ(fault_of(pixels.frame()), "");
  pixels.depth_m[5] = 400;
  EXPECT_NE(fault_of(pixels.frame()), "");
  pixels.mask.assign(12, 0);
  for (std::size_t p = 0; p < 5; ++p) pixels.mask[p] = 255;
  EXPECT_EQ(fault_of(pixels.frame()), "");
}

TEST(Frame, EveryFaultIsListed) {
  Pixels pixels;
  pixels.mask.resize(1);
  pixels.depth_m.resize(2);
  auto frame = pixels.frame();
  frame.intrinsics.fy = -1;
  const auto fault = fault_of(frame);
  EXPECT_THAT(fault, HasSubstr("Frame.mask"));
  EXPECT_THAT(fault, HasSubstr("Frame.depth_m"));
  EXPECT_THAT(fault, HasSubstr("Frame.intrinsics.fy"));
}

}  // namespace
}  // namespace flowdlo
