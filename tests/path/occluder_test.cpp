// Occluders: bars before the rope, with depths that show them.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "canvas.hpp"
#include "path/cover.hpp"
#include "path/path.hpp"
#include "path/region.hpp"

namespace flowdlo::test {
namespace {

constexpr float kRope_m = 0.60F;
constexpr float kTable_m = 0.65F;
constexpr float kBar_m = 0.50F;

// A rope before a table, all of it with depths.
Canvas rope(const std::vector<Curve>& curves, int width_px) {
  Canvas canvas;
  std::fill(canvas.depth_m.begin(), canvas.depth_m.end(), kTable_m);
  for (const Curve& curve : curves) {
    canvas.stroke(curve, width_px).depth(curve, width_px, kRope_m);
  }
  return canvas;
}

Canvas& hide(Canvas& canvas, const cv::Rect& box) {
  canvas.erase(box);
  cv::Mat(canvas.mask.size(), CV_32F, canvas.depth_m.data())(box) = kBar_m;
  return canvas;
}

// A circle of radius 80 around (320, 240), from one angle to another, in turns.
Curve arc(double from, double to) {
  return curve_of([&](double t) {
    const double angle = 2 * kPi * (from + (to - from) * t);
    return std::pair{320 + 80 * std::cos(angle), 240 + 80 * std::sin(angle)};
  });
}

// Of the curve's points from the path; how far the rope's round tips reach beyond does not count.
float farthest_off(const path::Path& path, const Curve& curve) {
  float most = 0;
  for (const cv::Point& p : curve) most = std::max(most, distance_to(path.points_px, p));
  return most;
}

TEST(Occluder, LinksRunUnderTheBarAndNotBeforeTheTable) {
  // An S whose lower end lies near the gap: straight over the table would be shorter.
  Curve curve{{60, 120}, {420, 120}};
  const Curve turn = curve_of([](double t) {
    const double angle = kPi * (t - 0.5);
    return std::pair{420 + 90 * std::cos(angle), 210 + 90 * std::sin(angle)};
  });
  curve.insert(curve.end(), turn.begin(), turn.end());
  curve.insert(curve.end(), {{420, 300}, {200, 300}, {200, 180}});
  Canvas canvas = rope({curve}, 14);
  hide(canvas, {455, 90, 80, 240});

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  EXPECT_LT(frechet(traced->ranked.front(), dense(curve)), 14.0F);
}

TEST(Occluder, AnArcGoesOnAsAnArcUnderIt) {
  const Curve curve = arc(0.05, 0.95);
  Canvas canvas = rope({curve}, 14);
  hide(canvas, {200, 200, 90, 80});  // a quarter of the circle's left side

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  EXPECT_LT(farthest_off(traced->ranked.front(), curve), 8.5F) << "a chord would be off by 10";
}

// A rope on a table seen aslant: the lower in the image, the nearer, four millimetres a row. The
// rope stands before what lies behind it by about its thickness over the slope's cosine.
constexpr float kOnSlope_m = kRope_m - 0.028F;
Canvas on_a_slope() {
  const Curve line{{100, 240}, {540, 240}};
  Canvas canvas;
  for (int v = 0; v < canvas.mask.rows; ++v) {
    for (int u = 0; u < canvas.mask.cols; ++u) {
      canvas.depth_m[static_cast<std::size_t>(v * canvas.mask.cols + u)] =
          kRope_m + 0.004F * static_cast<float>(240 - v);
    }
  }
  return canvas.stroke(line, 9).depth(line, 9, kOnSlope_m);
}

path::Sight below(const Canvas& canvas) {
  const auto region = path::clean(canvas.frame());
  const Vector2f p(320.0F - static_cast<float>(region->offset_px.x),
                   240.0F - static_cast<float>(region->offset_px.y));
  return path::Cover(*region, canvas.frame(), 9).beyond(p, {0, 1}, kOnSlope_m, 20);
}

TEST(Cover, ATableSeenAslantHidesNothing) { EXPECT_NE(below(on_a_slope()), path::Sight::kHidden); }

TEST(Cover, WhatStandsOnATableSeenAslantHides) {
  Canvas canvas = on_a_slope();
  for (int v = 244; v < 300; ++v) {
    for (int u = 300; u < 340; ++u) {
      canvas.depth_m[static_cast<std::size_t>(v * canvas.mask.cols + u)] -= 0.06F;
    }
  }
  EXPECT_EQ(below(canvas), path::Sight::kHidden);
}

TEST(Cover, TellsWhatIsNearerFromWhatIsFartherThanTheRope) {
  const Curve curve{{60, 240}, {580, 240}};
  Canvas canvas = rope({curve}, 20);
  hide(canvas, {300, 200, 40, 80});
  canvas.depth({{100, 100}, {200, 100}}, 40, 0.0F);
  const Frame frame = canvas.frame();
  const auto region = path::clean(frame);
  ASSERT_TRUE(region);
  const path::Cover cover(*region, frame, 20);
  const Vector2f offset(static_cast<float>(region->offset_px.x),
                        static_cast<float>(region->offset_px.y));

  EXPECT_EQ(cover.at(Vector2f(320, 240) - offset, kRope_m), path::Sight::kHidden);
  EXPECT_EQ(cover.at(Vector2f(400, 280) - offset, kRope_m), path::Sight::kOpen);
  EXPECT_EQ(cover.at(Vector2f(150, 100) - offset, kRope_m), path::Sight::kUnknown) << "no depth";
  EXPECT_EQ(cover.at(Vector2f(320, 240) - offset, 0), path::Sight::kUnknown) << "nor of the rope";
  EXPECT_EQ(cover.beyond(Vector2f(290, 240) - offset, {1, 0}, kRope_m, 40), path::Sight::kHidden);
  EXPECT_EQ(cover.beyond(Vector2f(200, 240) - offset, {0, 1}, kRope_m, 40), path::Sight::kOpen);
  EXPECT_EQ(cover.beyond(Vector2f(200, 240) - offset, {1, 0}, kRope_m, 40), path::Sight::kUnknown)
      << "farther than asked";
}

TEST(Cover, MeetsAStrandThatPassesBeyondAnEndAndNoneInTheOpen) {
  Canvas canvas = Canvas().stroke({{60, 240}, {300, 240}}, 9).stroke({{310, 100}, {310, 380}}, 9);
  canvas.erase({303, 200, 2, 80});  // two pixels between the end and the strand
  const Frame frame = canvas.frame();
  const auto region = path::clean(frame);
  ASSERT_TRUE(region);
  const path::Cover cover(*region, frame, 9);
  const Eigen::Vector2f offset = path::offset_of(*region);
  const Eigen::Vector2f right = Eigen::Vector2f(296, 240) - offset;
  const Eigen::Vector2f left = Eigen::Vector2f(64, 240) - offset;
  EXPECT_TRUE(cover.meets(right, {1, 0}, 27));
  EXPECT_FALSE(cover.meets(left, {-1, 0}, 27));
  EXPECT_TRUE(cover.near_mask(Eigen::Vector2f(304, 240) - offset));
  EXPECT_FALSE(cover.near_mask(Eigen::Vector2f(64, 260) - offset));
}

}  // namespace
}  // namespace flowdlo::test
