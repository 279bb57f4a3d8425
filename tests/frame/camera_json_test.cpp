#include "frame/camera_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace flowdlo::frame {
namespace {

using testing::HasSubstr;

std::string fault_of(const std::string& text) {
  const auto camera = parse_camera(text, "camera.json");
  if (camera) return "";
  EXPECT_EQ(camera.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(camera.error().message, testing::StartsWith("camera.json: "));
  return camera.error().message;
}

std::string own(const std::string& fx, const std::string& depth_scale = "0.001") {
  return R"({"width": 640, "height": 480, "fx": )" + fx +
         R"(, "fy": 602, "cx": 320.5, "cy": 240.25, "depth_scale": )" + depth_scale + "}";
}

void expect_intrinsics(const CameraFile& camera) {
  EXPECT_FLOAT_EQ(camera.intrinsics.fx, 601.0F);
  EXPECT_FLOAT_EQ(camera.intrinsics.fy, 602.0F);
  EXPECT_FLOAT_EQ(camera.intrinsics.cx, 320.5F);
  EXPECT_FLOAT_EQ(camera.intrinsics.cy, 240.25F);
}

TEST(CameraJson, OwnFormIsRead) {
  const auto camera = parse_camera(own("601", "0.0005"), "camera.json");
  ASSERT_TRUE(camera) << camera.error().message;
  expect_intrinsics(*camera);
  EXPECT_EQ(camera->width, 640);
  EXPECT_EQ(camera->height, 480);
  EXPECT_DOUBLE_EQ(camera->depth_scale_m, 0.0005);
}

TEST(CameraJson, BopMatrixIsRowMajorAndItsDepthScaleInMillimetres) {
  const auto camera = parse_camera(
      R"({"cam_K": [601, 0, 320.5, 0, 602, 240.25, 0, 0, 1], "depth_scale": 0.1})", "camera.json");
  ASSERT_TRUE(camera) << camera.error().message;
  expect_intrinsics(*camera);
  EXPECT_EQ(camera->width, 0) << "BOP's form does not say";
  EXPECT_DOUBLE_EQ(camera->depth_scale_m, 0.0001);
}

TEST(CameraJson, Open3dMatrixIsColumnMajorAndItsDepthInMillimetresUnlessSaid) {
  const auto camera = parse_camera(
      R"({"width": 640, "height": 480,
          "intrinsic_matrix": [601, 0, 0, 0, 602, 0, 320.5, 240.25, 1]})",
      "camera.json");
  ASSERT_TRUE(camera) << camera.error().message;
  expect_intrinsics(*camera);
  EXPECT_DOUBLE_EQ(camera->depth_scale_m, 0.001);
}

TEST(CameraJson, TransposedMatrixIsRefused) {
  EXPECT_THAT(fault_of(R"({"cam_K": [601, 0, 0, 0, 602, 0, 320.5, 240.25, 1], "depth_scale": 1})"),
              HasSubstr("transpose it"));
  EXPECT_THAT(fault_of(R"({"width": 640, "height": 480,
                           "intrinsic_matrix": [601, 0, 320.5, 0, 602, 240.25, 0, 0, 1]})"),
              HasSubstr("transpose it"));
}

TEST(CameraJson, SkewIsRefused) {
  EXPECT_THAT(fault_of(R"({"cam_K": [601, 2, 320.5, 0, 602, 240.25, 0, 0, 1], "depth_scale": 1})"),
              HasSubstr("skew"));
}

TEST(CameraJson, MatrixMustHoldNineNumbers) {
  EXPECT_THAT(fault_of(R"({"cam_K": [601, 0, 320.5], "depth_scale": 1})"), HasSubstr("9 numbers"));
  EXPECT_THAT(fault_of(R"({"cam_K": [1, 2, 3, 4, "5", 6, 7, 8, 9], "depth_scale": 1})"),
              HasSubstr("9 numbers"));
  EXPECT_THAT(fault_of(R"({"cam_K": null, "depth_scale": 1})"), HasSubstr("9 numbers"));
}

TEST(CameraJson, DistortionIsRefusedUnlessItIsNone) {
  const std::string plain =
      R"({"cam_K": [601, 0, 320.5, 0, 602, 240.25, 0, 0, 1], "depth_scale": 1)";
  for (const char* lens :
       {R"("D": [0.1, 0, 0, 0, 0])", R"("dist_coeffs": [[0.1, 0]])", R"("k1": -0.2)"}) {
    EXPECT_THAT(fault_of(plain + ", " + lens + "}"), HasSubstr("rectified")) << lens;
  }
  EXPECT_EQ(fault_of(plain + R"(, "D": [0, 0, 0, 0, 0], "k1": 0})"), "");
}

TEST(CameraJson, TwoFormsAtOnceAreRefused) {
  EXPECT_THAT(fault_of(R"({"fx": 1, "cam_K": [1, 0, 1, 0, 1, 1, 0, 0, 1], "depth_scale": 1})"),
              HasSubstr("keep one"));
}

class UnusableNumber : public testing::TestWithParam<const char*> {};

TEST_P(UnusableNumber, IsRefusedAsFocalLength) { EXPECT_FALSE(fault_of(own(GetParam())).empty()); }
TEST_P(UnusableNumber, IsRefusedAsDepthScale) {
  EXPECT_FALSE(fault_of(own("601", GetParam())).empty());
}

INSTANTIATE_TEST_SUITE_P(CameraJson, UnusableNumber,
                         testing::Values("0", "-600", "1e30", "1e999", "-1e999", "NaN", "Infinity",
                                         "null", "\"600\"", "[600]", "true", "{}"));

TEST(CameraJson, OpenThreeDsUnitsPerMetreAreExplained) {
  EXPECT_THAT(fault_of(own("601", "1000")), HasSubstr("0.001 means a depth.png in millimetres"));
}

TEST(CameraJson, NanIsNamedAsTheLikelyCause) {
  EXPECT_THAT(fault_of("{\n\"fx\": NaN}"), HasSubstr("line 2 (numbers must be finite"));
}

TEST(CameraJson, WrongTypesAreNamedWithWhatCame) {
  EXPECT_THAT(fault_of("[1, 2]"), HasSubstr("expected a JSON object, got [1,2]"));
  EXPECT_THAT(fault_of("\"camera\""), HasSubstr("expected a JSON object"));
  EXPECT_THAT(fault_of(own("\"600\"")), HasSubstr("\"fx\": expected a number, got \"600\""));
}

TEST(CameraJson, WhatIsNoJsonIsRefused) {
  for (const char* text : {"", "{", "fx: 600", "{\"fx\": 6", "\xFF\xFE{}", "{\"fx\" 1}"}) {
    EXPECT_FALSE(fault_of(text).empty()) << text;
  }
}

TEST(CameraJson, SidesMustBeWholeAndWithinTheLimit) {
  for (const char* side : {"0", "-640", "640.5", "4097", "1e300", "\"640\""}) {
    const std::string text = std::string(R"({"width": )") + side +
                             R"(, "height": 480, "fx": 1, "fy": 1, "cx": 0, "cy": 0,
                                 "depth_scale": 0.001})";
    EXPECT_THAT(fault_of(text), HasSubstr("\"width\"")) << side;
  }
}

TEST(CameraJson, KeyThatStandsTwiceIsRefusedWhicheverValueIsRight) {
  const std::string twice = R"({"width": 640, "height": 480, "fx": 601, "fy": 602, "cx": 320,
                                "cy": 240, "depth_scale": 0.001, "fx": 601, "cx": 321})";
  EXPECT_THAT(fault_of(twice), HasSubstr("\"fx\" is given twice; keep one"));
  EXPECT_THAT(fault_of(twice), HasSubstr("\"cx\" is given twice"));
  std::string nested = own("601");
  nested.insert(1, R"("notes": {"by": 1, "by": 2}, )");
  EXPECT_THAT(fault_of(nested), HasSubstr("\"by\" is given twice"));
}

TEST(CameraJson, SameKeyInTwoObjectsIsNoRepetition) {
  std::string text = own("601");
  text.insert(1, R"("a": {"by": 1}, "b": [{"by": 2}, {"by": 3}], )");
  EXPECT_TRUE(parse_camera(text, "camera.json"));
}

TEST(CameraJson, EveryMissingFieldIsListed) {
  const auto fault = fault_of("{}");
  for (const char* field : {"width", "height", "fx", "fy", "cx", "cy", "depth_scale"}) {
    EXPECT_THAT(fault, HasSubstr(std::string(field) + "\" is missing"));
  }
}

TEST(CameraJson, DeepNestingIsHarmless) {
  EXPECT_FALSE(fault_of(std::string(200000, '[')).empty());
  EXPECT_FALSE(fault_of(std::string(100000, '[') + std::string(100000, ']')).empty());
}

TEST(CameraJson, WhatIsWrittenReadsBackExactly) {
  const CameraFile written{1280, 720, {606.692F, 606.362F, 637.535F, 366.723F}, 0.00025};
  const auto read = parse_camera(format_camera(written), "camera.json");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->width, written.width);
  EXPECT_EQ(read->height, written.height);
  EXPECT_EQ(read->intrinsics.fx, written.intrinsics.fx);
  EXPECT_EQ(read->intrinsics.fy, written.intrinsics.fy);
  EXPECT_EQ(read->intrinsics.cx, written.intrinsics.cx);
  EXPECT_EQ(read->intrinsics.cy, written.intrinsics.cy);
  EXPECT_EQ(read->depth_scale_m, written.depth_scale_m);
}

}  // namespace
}  // namespace flowdlo::frame
