#include <gtest/gtest.h>

#include <cmath>

#include "canvas.hpp"
#include "path/path.hpp"

namespace flowdlo::test {
namespace {

Curve wave() {
  return curve_of([](double t) {
    return std::pair{60 + 500 * t, 240 + 110 * std::sin(2 * kPi * t)};
  });
}

TEST(Gap, UnderABarIsBridgedAndMarked) {
  const Canvas canvas = Canvas().stroke(wave(), 12).erase({290, 0, 40, 480});

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  const path::Path& best = traced->ranked.front();
  EXPECT_LT(frechet(best, wave()), 10.0F);
  for (std::size_t i = 0; i < best.points_px.size(); ++i) {
    const float u = best.points_px[i].x();
    if (u > 295 && u < 325) {
      EXPECT_EQ(best.bridged[i], 1) << u;
    }
    if (u < 280 || u > 340) {
      EXPECT_EQ(best.bridged[i], 0) << u;
    }
  }
}

TEST(Gap, ThreePiecesBecomeOnePath) {
  const Canvas canvas =
      Canvas().stroke(wave(), 12).erase({180, 0, 35, 480}).erase({400, 0, 45, 480});

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  EXPECT_LT(frechet(traced->ranked.front(), wave()), 12.0F);
}

TEST(Gap, ALongPieceFarAwayIsLinkedRatherThanLeftOut) {
  const Curve near{{40, 300}, {200, 300}};
  const Curve far{{500, 120}, {600, 80}};
  const auto traced = path::trace(Canvas().stroke(near, 4).stroke(far, 4).frame());

  ASSERT_TRUE(traced);
  const path::Path& best = traced->ranked.front();
  for (const cv::Point& end : {near.front(), far.back()}) {
    EXPECT_LT(std::min(distance_to({best.points_px.front()}, end),
                       distance_to({best.points_px.back()}, end)),
              6.0F);
  }
}

TEST(Gap, LinksFollowTheDirectionNotTheNearestTip) {
  // Two parallel strands cut by one bar: the tips beside each other are nearer than those across.
  const Curve curve = [] {
    Curve line{{60, 225}, {480, 225}};
    const Curve turn = curve_of([](double t) {
      const double angle = -0.5 * kPi + kPi * t;
      return std::pair{480 + 20 * std::cos(angle), 245 + 20 * std::sin(angle)};
    });
    line.insert(line.end(), turn.begin(), turn.end());
    line.insert(line.end(), {{480, 265}, {60, 265}});
    return line;
  }();
  const Canvas canvas = Canvas().stroke(curve, 12).erase({250, 0, 70, 480});

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  for (const Vector2f& p : traced->ranked.front().points_px) {
    if (p.x() > 240 && p.x() < 330) {
      EXPECT_LT(std::min(std::abs(p.y() - 225), std::abs(p.y() - 265)), 6);
    }
  }
}

TEST(Gap, TwoSpecksAreNoPartOfTheRope) {
  Canvas canvas = Canvas().stroke(wave(), 12);
  cv::circle(canvas.mask, {500, 60}, 3, cv::Scalar(255), -1);
  cv::circle(canvas.mask, {120, 430}, 4, cv::Scalar(255), -1);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  EXPECT_LT(frechet(traced->ranked.front(), wave()), 10.0F);
  for (const std::uint8_t bridged : traced->ranked.front().bridged) EXPECT_EQ(bridged, 0);
}

TEST(Gap, DepthKeepsStrandsOfDifferentHeightsApart) {
  // A cross of two strands under a square: with depth each goes on at its own height, and the
  // pairing that bends is taken only because of it.
  const Curve high_in{{80, 160}, {270, 220}};
  const Curve high_out{{370, 220}, {560, 160}};
  const Curve low_in{{80, 320}, {270, 260}};
  const Curve low_out{{370, 260}, {560, 320}};
  Canvas canvas;
  for (const Curve& curve : {high_in, high_out}) canvas.stroke(curve, 12).depth(curve, 14, 0.40F);
  for (const Curve& curve : {low_in, low_out}) canvas.stroke(curve, 12).depth(curve, 14, 0.80F);
  const Curve right{{560, 160}, {600, 240}, {560, 320}};
  canvas.stroke(right, 12);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  bool crossed = false;
  for (const Vector2f& p : traced->ranked.front().points_px) {
    crossed = crossed || (std::abs(p.x() - 320) < 2 && std::abs(p.y() - 240) < 4);
  }
  EXPECT_FALSE(crossed) << "the straight links would meet in the middle";
}

}  // namespace
}  // namespace flowdlo::test
