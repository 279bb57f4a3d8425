// Whatever the mask holds: an answer that keeps every promise, or kNoPath and a sentence.
#include <gtest/gtest.h>

#include <string>

#include "canvas.hpp"
#include "path/path.hpp"

namespace flowdlo::test {
namespace {

void expect_sound_or_no_path(const Canvas& canvas, const std::string& what) {
  const auto traced = path::trace(canvas.frame());
  if (!traced) {
    EXPECT_EQ(traced.error().code, ErrorCode::kNoPath) << what << ": " << traced.error().message;
    EXPECT_FALSE(traced.error().message.empty()) << what;
    return;
  }
  ASSERT_FALSE(traced->ranked.empty()) << what;
  EXPECT_GE(traced->margin, 0) << what;
  EXPECT_LE(traced->margin, 1) << what;
  EXPECT_GT(traced->rope_width_px, 0) << what;
  for (const path::Path& path : traced->ranked) EXPECT_TRUE(sound(path, canvas.frame())) << what;
}

TEST(HostileMask, EmptyOneHasNoPathAndSaysSo) {
  const auto traced = path::trace(Canvas().frame());

  ASSERT_FALSE(traced);
  EXPECT_EQ(traced.error().code, ErrorCode::kNoPath);
  EXPECT_NE(traced.error().message.find("no pixel"), std::string::npos);
}

TEST(HostileMask, SpecksAloneAreNoPath) {
  Canvas canvas;
  canvas.mask(cv::Rect{100, 100, 3, 3}) = 255;
  canvas.mask(cv::Rect{300, 200, 2, 2}) = 255;
  canvas.mask.at<std::uint8_t>(400, 500) = 255;

  const auto traced = path::trace(canvas.frame());

  ASSERT_FALSE(traced);
  EXPECT_EQ(traced.error().code, ErrorCode::kNoPath);
  EXPECT_NE(traced.error().message.find("speck"), std::string::npos);
}

TEST(HostileMask, OnePixelImageIsAnswered) {
  Canvas dark(1, 1);
  expect_sound_or_no_path(dark, "dark");
  Canvas lit(1, 1);
  lit.mask = 255;
  expect_sound_or_no_path(lit, "lit");
}

TEST(HostileMask, SinglePixelAnywhereIsNoPath) {
  for (const cv::Point p : {cv::Point{0, 0}, {639, 0}, {0, 479}, {639, 479}, {320, 240}}) {
    Canvas canvas;
    canvas.mask.at<std::uint8_t>(p) = 255;
    EXPECT_FALSE(path::trace(canvas.frame()));
  }
}

TEST(HostileMask, FullImageIsAnswered) {
  for (const cv::Size size :
       {cv::Size{640, 480}, {480, 640}, {64, 64}, {7, 3}, {200, 1}, {1, 200}}) {
    Canvas canvas(size.width, size.height);
    canvas.mask = 255;
    expect_sound_or_no_path(canvas, std::to_string(size.width) + "x" + std::to_string(size.height));
  }
}

TEST(HostileMask, CheckerboardsAreAnswered) {
  for (const int side : {1, 2, 3, 8, 33}) {
    Canvas canvas;
    for (int v = 0; v < 480; ++v) {
      for (int u = 0; u < 640; ++u) {
        if ((u / side + v / side) % 2 == 0) canvas.mask.at<std::uint8_t>(v, u) = 255;
      }
    }
    expect_sound_or_no_path(canvas, "side " + std::to_string(side));
  }
}

TEST(HostileMask, NoiseIsAnswered) {
  for (const int percent : {1, 5, 20, 40, 50, 60, 80, 95, 99}) {
    Canvas canvas;
    cv::RNG random(static_cast<std::uint64_t>(percent));
    for (int v = 0; v < 480; ++v) {
      for (int u = 0; u < 640; ++u) {
        if (random.uniform(0, 100) < percent) canvas.mask.at<std::uint8_t>(v, u) = 255;
      }
    }
    expect_sound_or_no_path(canvas, std::to_string(percent) + " %");
  }
}

TEST(HostileMask, GridsWithHundredsOfJunctionsAreAnswered) {
  for (const int pitch : {12, 20, 40}) {
    Canvas canvas;
    for (int u = 10; u < 640; u += pitch) canvas.stroke({{u, 5}, {u, 475}}, 4);
    for (int v = 10; v < 480; v += pitch) canvas.stroke({{5, v}, {635, v}}, 4);
    expect_sound_or_no_path(canvas, "pitch " + std::to_string(pitch));
  }
}

TEST(HostileMask, HundredsOfPiecesAreAnswered) {
  Canvas canvas;
  for (int v = 10; v < 470; v += 14) {
    for (int u = 10; u < 600; u += 40) canvas.stroke({{u, v}, {u + 25, v}}, 5);
  }
  expect_sound_or_no_path(canvas, "dashes");
}

TEST(HostileMask, BlobHasItsLongAxis) {
  Canvas canvas;
  cv::ellipse(canvas.mask, {320, 240}, {60, 35}, 30, 0, 360, cv::Scalar(255), -1);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  const auto& points = traced->ranked.front().points_px;
  const Vector2f along = (points.back() - points.front()).normalized();
  EXPECT_GT(std::abs(along.dot(Vector2f(0.866F, 0.5F))), 0.9F);
  EXPECT_GT((points.back() - points.front()).norm(), 70.0F);
}

TEST(HostileMask, DiscIsAnswered) {
  for (const int radius : {2, 3, 5, 20, 100}) {
    Canvas canvas;
    cv::circle(canvas.mask, {320, 240}, radius, cv::Scalar(255), -1);
    expect_sound_or_no_path(canvas, "radius " + std::to_string(radius));
  }
}

TEST(HostileMask, AStrokeOfFiveWidthsAlwaysHasAPath) {
  for (const int width : {3, 5, 9, 15, 31}) {
    for (const double angle : {0.0, 0.3, 0.785, 1.2, 1.57}) {
      const cv::Point a{320, 240};
      const cv::Point b{a.x + static_cast<int>(5.0 * width * std::cos(angle)),
                        a.y + static_cast<int>(5.0 * width * std::sin(angle))};
      const Canvas canvas = Canvas().stroke({a, b}, width);

      const auto traced = path::trace(canvas.frame());

      ASSERT_TRUE(traced) << width << " " << angle;
      EXPECT_LT(distance_to(traced->ranked.front().points_px, a), 0.7 * width + 3);
      EXPECT_LT(distance_to(traced->ranked.front().points_px, b), 0.7 * width + 3);
    }
  }
}

TEST(HostileMask, DepthOfAnyKindIsSurvived) {
  Canvas canvas = Canvas().stroke({{60, 100}, {560, 380}}, 12).stroke({{60, 380}, {560, 100}}, 12);
  for (const float depth : {0.0F, -1.0F, 1e-12F, 1e30F, std::numeric_limits<float>::infinity(),
                            std::numeric_limits<float>::quiet_NaN()}) {
    std::fill(canvas.depth_m.begin(), canvas.depth_m.end(), depth);
    expect_sound_or_no_path(canvas, "depth " + std::to_string(depth));
  }
}

}  // namespace
}  // namespace flowdlo::test
