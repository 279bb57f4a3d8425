#include "frame_picture.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <vector>

#include "mask_overlay.hpp"
#include "mat/mat_image.hpp"
#include "overlay_style.hpp"

namespace flowdlo::tools {
namespace {

/// 64 x 48 px of noise, with a mask of a slanted stroke.
struct Scene {
  cv::Mat color = cv::Mat(48, 64, CV_8UC3);
  cv::Mat mask = cv::Mat::zeros(48, 64, CV_8UC1);
  std::vector<float> depth_m = std::vector<float>(64 * 48, 0.5F);

  Scene() {
    cv::RNG random(3);
    random.fill(color, cv::RNG::UNIFORM, 0, 256);
    cv::line(mask, {-3, 6}, {50, 44}, cv::Scalar(200), 6);
  }
  [[nodiscard]] Frame frame(bool colored = true) const {
    return {64,
            48,
            {100, 100, 31.5F, 23.5F},
            depth_m,
            {mask.data, mask.total()},
            {color.data, colored ? 3 * color.total() : 0}};
  }
};

cv::Mat grey_of(const cv::Mat& color) {
  cv::Mat grey;
  cv::cvtColor(color, grey, cv::COLOR_BGR2GRAY);
  cv::cvtColor(grey, grey, cv::COLOR_GRAY2BGR);
  return grey;
}

cv::Scalar scalar_of(const Color& color) {
  return {static_cast<double>(color[0]), static_cast<double>(color[1]),
          static_cast<double>(color[2])};
}

TEST(FramePicture, PaledIsAsOpenCVWeighsColourAndGrey) {
  const Scene scene;
  cv::Mat expected;
  cv::addWeighted(scene.color, 0.45, grey_of(scene.color), 0.25, 0, expected);
  EXPECT_LE(cv::norm(mat::mat_over(paled(scene.frame())), expected, cv::NORM_INF), 1);
}

TEST(FramePicture, WithoutColourTheMaskIsPaled) {
  const Scene scene;
  const auto picture = paled(scene.frame(false));
  cv::Mat expected(48, 64, CV_8UC3, cv::Scalar::all(40));
  expected.setTo(cv::Scalar::all(129), scene.mask > 127);
  EXPECT_EQ(cv::norm(mat::mat_over(picture), expected, cv::NORM_INF), 0);
}

TEST(FramePicture, GroundIsAWholeMultipleOfTheFrame) {
  const Scene scene;
  const auto ground = ground_of(scene.frame());
  EXPECT_EQ(ground.zoom, 8);
  EXPECT_EQ(ground.picture.size(), (image::Size{512, 384}));
  cv::Mat expected;
  cv::resize(cv::Mat(scene.mask > 127), expected, {512, 384}, 0, 0, cv::INTER_NEAREST);
  EXPECT_EQ(cv::norm(mat::mat_over(ground.rope), expected, cv::NORM_INF), 0);
}

TEST(FramePicture, OutlineIsTheMasksBorderWithSoftSides) {
  const Scene scene;
  const Frame frame = scene.frame(false);
  const auto ground = ground_of(frame);
  cv::Mat inner;
  const cv::Mat cross = cv::getStructuringElement(cv::MORPH_CROSS, {3, 3});
  const cv::Mat mask = mat::mat_over(ground.rope);
  cv::erode(mask, inner, cross, {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  const cv::Mat border = mask - inner;
  cv::Mat beside;
  cv::dilate(border, beside, cv::Mat::ones(3, 3, CV_8UC1));
  cv::Mat plain;
  cv::resize(mat::mat_over(paled(frame)), plain, {512, 384}, 0, 0, cv::INTER_NEAREST);
  cv::Mat change;
  cv::absdiff(mat::mat_over(ground.picture), plain, change);
  cv::extractChannel(change, change, 0);
  EXPECT_EQ(cv::countNonZero((border > 0) & (change < 60)), 0) << "the border is drawn";
  EXPECT_EQ(cv::countNonZero((beside == 0) & (change > 0)), 0) << "nothing beyond its neighbours";
  EXPECT_GT(cv::countNonZero((border == 0) & (change > 0) & (change < 45)), 100) << "softly";
}

TEST(MaskOverlay, DimsWhatIsNoMaskAndLinesItsBorder) {
  const Scene scene;
  const auto picture = draw_mask_overlay(scene.frame());
  const cv::Mat mask = scene.mask > 127;
  cv::Mat expected = grey_of(scene.color);
  expected.convertTo(expected, -1, 0.45);
  scene.color.copyTo(expected, mask);
  cv::Mat grown;
  cv::dilate(mask, grown, cv::Mat::ones(3, 3, CV_8UC1));
  expected.setTo(scalar_of(kSupportedColor), grown & ~mask);
  EXPECT_LE(cv::norm(mat::mat_over(picture), expected, cv::NORM_INF), 1);
}

TEST(MaskOverlay, OfAFrameWithoutColourShowsTheMaskAlone) {
  const Scene scene;
  const auto picture = draw_mask_overlay(scene.frame(false));
  EXPECT_EQ(picture.at(0, 63), support::color_of(40));
  EXPECT_EQ(picture.at(24, 22), support::color_of(200));
}

}  // namespace
}  // namespace flowdlo::tools
