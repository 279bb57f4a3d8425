// How long a mask's strokes are, and what happens to more of them than one rope has.
#include "path/strokes.hpp"

#include <gtest/gtest.h>

#include "canvas.hpp"
#include "mat/mat_image.hpp"
#include "path/limits.hpp"
#include "path/path.hpp"

namespace flowdlo::test {
namespace {

constexpr std::int64_t kMost = std::int64_t{path::kMostStrokeSides} * (640 + 480);

cv::Mat noise(int percent) {
  cv::Mat mask = cv::Mat::zeros(480, 640, CV_8U);
  cv::RNG random(7);
  for (int v = 1; v < 479; ++v) {
    for (int u = 1; u < 639; ++u) {
      mask.at<std::uint8_t>(v, u) = random.uniform(0, 100) < percent ? 1 : 0;
    }
  }
  return mask;
}

cv::Mat rope(int width_px) { return Canvas().stroke({{60, 100}, {560, 380}}, width_px).mask / 255; }

std::int64_t length_of(const cv::Mat& mask) {
  return path::stroke_length_px(mat::image_of<std::uint8_t>(mask));
}
Result<path::Strokes> strokes_in(const cv::Mat& mask, const image::Size& size, int ropes = 1) {
  return path::strokes_of(mat::image_of<std::uint8_t>(mask), size, ropes);
}

TEST(StrokeLength, OfOneStrokeIsItsLengthWhateverItsWidth) {
  const double length_px = std::hypot(500, 280);
  for (const int width_px : {5, 9, 21}) {
    EXPECT_NEAR(static_cast<double>(length_of(rope(width_px))), length_px,
                0.2 * length_px + width_px);
  }
}

TEST(StrokeLength, OfNoiseIsFarBeyondAnyRopes) { EXPECT_GT(length_of(noise(50)), 2 * kMost); }

TEST(Strokes, OfARopeAreTheMaskItself) {
  const cv::Mat mask = rope(9);
  const auto strokes = strokes_in(mask, {640, 480});
  ASSERT_TRUE(strokes);
  EXPECT_EQ(cv::countNonZero(mat::mat_over(strokes->mask) != mask), 0);
  EXPECT_FALSE(strokes->filtered);
}

TEST(Strokes, OfARopeUnderNoiseAreTheRopes) {
  cv::Mat mask = noise(30);
  mask |= rope(21);
  ASSERT_GT(length_of(mask), kMost) << "else nothing is filtered";
  const auto strokes = strokes_in(mask, {640, 480});
  ASSERT_TRUE(strokes) << strokes.error().message;
  EXPECT_TRUE(strokes->filtered);
  EXPECT_LE(path::stroke_length_px(strokes->mask), kMost);
  const cv::Mat core = rope(9);
  EXPECT_GT(cv::countNonZero(mat::mat_over(strokes->mask) & core), 0.95 * cv::countNonZero(core));
}

TEST(Strokes, OfCablesFromEdgeToEdgeAreThoseOfSeveralRopesOnly) {
  Canvas canvas;
  for (int row = 20; row < 480; row += 24) canvas.stroke({{2, row}, {637, row}}, 5);
  const cv::Mat mask = canvas.mask / 255;
  ASSERT_GT(length_of(mask), kMost);
  const auto several = strokes_in(mask, {640, 480}, 0);
  ASSERT_TRUE(several) << several.error().message;
  EXPECT_FALSE(several->filtered);
  const auto one = strokes_in(mask, {640, 480});
  EXPECT_TRUE(!one || one->filtered);
  std::fill(canvas.depth_m.begin(), canvas.depth_m.end(), 0.6F);  // a table below
  for (int row = 20; row < 480; row += 24) canvas.depth({{2, row}, {637, row}}, 5, 0.58F);
  const auto traced = path::trace_ropes(canvas.frame(), 0);
  ASSERT_TRUE(traced) << traced.error().message;
  EXPECT_EQ(traced->ropes.size(), 20U);
}

TEST(Strokes, OfNoiseAndOfCheckersAreNotSeveralRopesEither) {
  Canvas grain;
  grain.mask = 255 * noise(50);
  Canvas checkers;
  for (int v = 4; v < 476; ++v) {
    for (int u = 4; u < 636; ++u) {
      checkers.mask.at<std::uint8_t>(v, u) = (u / 16 + v / 16) % 2 == 0 ? 255 : 0;
    }
  }
  for (const Canvas& canvas : {checkers, grain}) {
    const auto traced = path::trace_ropes(canvas.frame(), 0);
    ASSERT_FALSE(traced) << traced->ropes.size();
    EXPECT_EQ(traced.error().code, ErrorCode::kNoPath);
  }
}

TEST(Strokes, OfATextureAreNoPathAndSaySo) {
  Canvas canvas;
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; ++u) canvas.mask.at<std::uint8_t>(v, u) = u / 11 % 2 == 0 ? 255 : 0;
    if (v / 11 % 2 == 0) canvas.mask.row(v) = 255 - canvas.mask.row(v);
  }
  canvas.mask.row(0) = 0;
  canvas.mask.row(479) = 0;
  canvas.mask.col(0) = 0;
  canvas.mask.col(639) = 0;
  const auto strokes = strokes_in(canvas.mask / 255, {320, 240});
  ASSERT_FALSE(strokes);
  EXPECT_EQ(strokes.error().code, ErrorCode::kNoPath);
  EXPECT_NE(strokes.error().message.find("expected one rope"), std::string::npos);
  EXPECT_NE(strokes.error().message.find("check the segmentation"), std::string::npos);
}

}  // namespace
}  // namespace flowdlo::test
