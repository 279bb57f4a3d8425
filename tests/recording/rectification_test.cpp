#include "recording/rectification.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "mat/mat_image.hpp"

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

struct Moved {
  int u;
  int v;
  double from_u;
  double from_v;
};

// The figures are those of projectPoints of OpenCV 4.6.
void expect_moved(const Rectification& lens, const std::vector<Moved>& points) {
  for (const Moved& point : points) {
    const auto from = lens.source(point.u, point.v);
    EXPECT_NEAR(from.u, point.from_u, 1e-4) << point.u << ' ' << point.v;
    EXPECT_NEAR(from.v, point.from_v, 1e-4) << point.u << ' ' << point.v;
  }
}

/// Soft noise; OpenCV's remap by the lens' own places.
support::Picture soft_noise() {
  cv::Mat image(240, 320, CV_8UC3);
  cv::RNG random(5);
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(image, image, {0, 0}, 2);
  return mat::image_of<support::Color>(image);
}
cv::Mat remapped(const cv::Mat& image, const Rectification& lens, int interpolation) {
  cv::Mat map(240, 320, CV_32FC2);
  for (int v = 0; v < map.rows; ++v) {
    for (int u = 0; u < map.cols; ++u) {
      map.at<cv::Vec2f>(v, u) = {lens.source(u, v).u, lens.source(u, v).v};
    }
  }
  cv::Mat result;
  cv::remap(image, result, map, cv::noArray(), interpolation, cv::BORDER_CONSTANT);
  return result;
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

// OpenCV's remap counts in 1 / 32 of a pixel.
TEST(Rectification, ColourIsInterpolatedAsOpenCVDoes) {
  for (const double k1 : {-0.25, 0.3}) {  // from beyond the image, and from within alone
    const auto lens = create(camera("plumb_bob", {k1, 0.08, 0.002, -0.0015, -0.01}));
    const auto image = soft_noise();
    const auto theirs = remapped(mat::mat_over(image), lens, cv::INTER_LINEAR);
    EXPECT_LE(cv::norm(mat::mat_over(lens.color(image)), theirs, cv::NORM_INF), 8) << k1;
    EXPECT_LT(cv::norm(mat::mat_over(lens.color(image)), theirs, cv::NORM_L1), 0.6 * 3 * 320 * 240)
        << k1;
  }
}

TEST(Rectification, DepthIsTakenAsOpenCVDoesAndNotMixed) {
  const auto lens = create(camera("plumb_bob", {-0.25, 0.08, 0, 0, 0}));
  cv::Mat depth_m(240, 320, CV_32FC1);
  cv::RNG(9).fill(depth_m, cv::RNG::UNIFORM, 0.3, 1.5);
  const auto result = lens.nearest(mat::image_of<float>(depth_m));
  const auto theirs = remapped(depth_m, lens, cv::INTER_NEAREST);
  EXPECT_EQ(cv::norm(mat::mat_over(result), theirs, cv::NORM_INF), 0);
  const cv::Mat mask = depth_m > 0.8;
  EXPECT_EQ(cv::norm(mat::mat_over(lens.nearest(mat::image_of<std::uint8_t>(mask))),
                     remapped(mask, lens, cv::INTER_NEAREST), cv::NORM_INF),
            0);
}

TEST(Rectification, WithoutDistortionChangesNoBit) {
  for (const auto& message : {camera("plumb_bob", {0, 0, 0, 0, 0}), camera("", {})}) {
    const auto lens = create(message);
    const auto image = soft_noise();
    EXPECT_EQ(lens.largest_shift_px(), 0);
    EXPECT_EQ(cv::norm(mat::mat_over(lens.color(image)), mat::mat_over(image), cv::NORM_INF), 0);
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
