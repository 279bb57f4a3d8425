#include "recording/rectification.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flowdlo::recording {
namespace {

using testing::HasSubstr;

CameraMessage camera(const std::string& model, std::vector<double> d) {
  CameraMessage message;
  message.width = 320;
  message.height = 240;
  message.model = model;
  message.d = std::move(d);
  message.k = {300, 0, 160, 0, 310, 120, 0, 0, 1};
  message.p = {250, 0, 150, 0, 0, 260, 110, 0, 0, 0, 1, 0};
  return message;
}

Rectification create(const CameraMessage& message, bool rectified = false) {
  auto result = Rectification::create(message, rectified, "info");
  EXPECT_TRUE(result) << result.error().message;
  return *result;
}

std::string refusal(const CameraMessage& message) {
  const auto result = Rectification::create(message, false, "info");
  return result ? "" : result.error().message;
}

// An image whose pixels say where they are.
cv::Mat places() {
  cv::Mat image(240, 320, CV_32FC2);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      image.at<cv::Vec2f>(v, u) = {static_cast<float>(u), static_cast<float>(v)};
    }
  }
  return image;
}

struct Moved {
  int u;
  int v;
  double from_u;
  double from_v;
};

// The figures are those of projectPoints of OpenCV 4.6.
void expect_moved(const Rectification& lens, const std::vector<Moved>& points) {
  const cv::Mat image = lens.color(places());
  for (const Moved& point : points) {
    const auto from = image.at<cv::Vec2f>(point.v, point.u);
    EXPECT_NEAR(from[0], point.from_u, 0.04) << point.u << ' ' << point.v;  // remap counts in 1/32
    EXPECT_NEAR(from[1], point.from_v, 0.04) << point.u << ' ' << point.v;
  }
}

TEST(Rectification, UndoesBrownsDistortion) {
  expect_moved(create(camera("plumb_bob", {-0.25, 0.08, 0.002, -0.0015, -0.01})),
               {{25, 27, 33.829777, 33.354760},
                {25, 182, 32.169144, 178.807737},
                {190, 27, 189.183700, 29.453030},
                {280, 182, 274.236400, 179.192640}});
}

TEST(Rectification, UndoesTheRationalModel) {
  expect_moved(
      create(camera("rational_polynomial", {0.5, -2.7, 0.0005, -0.0003, 1.5, 0.38, -2.5, 1.45})),
      {{25, 27, 22.195429, 25.131434},
       {190, 182, 190.162779, 182.353459},
       {280, 27, 282.194514, 25.320564},
       {280, 182, 281.969910, 183.058087}});
}

TEST(Rectification, UndoesAFishEye) {
  expect_moved(create(camera("equidistant", {-0.02, 0.01, -0.005, 0.001})),
               {{25, 27, 36.788729, 35.121124},
                {190, 182, 189.486592, 180.938957},
                {280, 27, 270.843143, 34.096564},
                {280, 182, 272.474367, 178.111756}});
}

TEST(Rectification, DepthIsTakenAndNotMixed) {
  const auto lens = create(camera("plumb_bob", {-0.25, 0.08, 0, 0, 0}));
  cv::Mat depth_m(240, 320, CV_32FC1, cv::Scalar(0.5));
  depth_m.colRange(0, 100).setTo(0.9);
  const cv::Mat result = lens.nearest(depth_m);
  for (int v = 0; v < result.rows; ++v) {
    for (int u = 0; u < result.cols; ++u) {
      const float value = result.at<float>(v, u);
      EXPECT_TRUE(value == 0.5F || value == 0.9F || value == 0.0F) << value;
    }
  }
}

TEST(Rectification, WithoutDistortionChangesNoBit) {
  for (const auto& message : {camera("plumb_bob", {0, 0, 0, 0, 0}), camera("", {})}) {
    const auto lens = create(message);
    EXPECT_EQ(lens.largest_shift_px(), 0);
    EXPECT_EQ(cv::norm(lens.color(places()), places(), cv::NORM_INF), 0);
    EXPECT_FLOAT_EQ(lens.intrinsics().fx, 300);
    EXPECT_FLOAT_EQ(lens.intrinsics().cy, 120);
  }
}

TEST(Rectification, KeepsKWhereItUndoesD) {
  const auto lens = create(camera("plumb_bob", {-0.25, 0.08, 0, 0, 0}));
  EXPECT_FLOAT_EQ(lens.intrinsics().fx, 300);
  EXPECT_FLOAT_EQ(lens.intrinsics().fy, 310);
  EXPECT_GT(lens.largest_shift_px(), 10);
}

TEST(Rectification, OfRectifiedImagesTakesP) {
  const auto lens = create(camera("plumb_bob", {-0.25, 0.08, 0, 0, 0}), true);
  EXPECT_FLOAT_EQ(lens.intrinsics().fx, 250);
  EXPECT_FLOAT_EQ(lens.intrinsics().fy, 260);
  EXPECT_FLOAT_EQ(lens.intrinsics().cx, 150);
  EXPECT_FLOAT_EQ(lens.intrinsics().cy, 110);
  EXPECT_EQ(lens.largest_shift_px(), 0);
}

TEST(Rectification, LensThatItDoesNotKnowIsRefused) {
  EXPECT_THAT(refusal(camera("thin_prism", {0.1, 0.2})), HasSubstr("\"thin_prism\" with 2"));
  EXPECT_THAT(refusal(camera("plumb_bob", {0.1, 0.2})), HasSubstr("--rectified"));
  EXPECT_THAT(refusal(camera("plumb_bob", {std::nan(""), 0.2, 0, 0, 0})), HasSubstr("expected"));
}

TEST(Rectification, CameraThatIsNoneIsRefused) {
  auto message = camera("", {});
  message.k = {};
  EXPECT_THAT(refusal(message), HasSubstr("a calibrated camera"));
  message = camera("", {});
  message.width = 0;
  EXPECT_THAT(refusal(message), HasSubstr("0 x 240"));
  message = camera("", {});
  message.cropped = true;
  EXPECT_THAT(refusal(message), HasSubstr("binning"));
  message = camera("", {});
  message.k[1] = 3;
  EXPECT_THAT(refusal(message), HasSubstr("skew"));
}

}  // namespace
}  // namespace flowdlo::recording
