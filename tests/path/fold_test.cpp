// Folds: a rope that turns back and returns behind itself, seen edge-on.
#include <gtest/gtest.h>

#include "canvas.hpp"
#include "path/path.hpp"

namespace flowdlo::test {
namespace {

constexpr int kWidthPx = 15;
const Curve kLeft{{110, 60}, {320, 300}};
const Curve kStem{{320, 300}, {320, 380}};
const Curve kRight{{320, 300}, {530, 60}};

TEST(Fold, HidesItsWayBackBehindTheStem) {
  const Canvas canvas =
      Canvas().stroke(kLeft, kWidthPx).stroke(kStem, kWidthPx).stroke(kRight, kWidthPx);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  ASSERT_TRUE(sound(traced->ranked.front(), canvas.frame()));
  const Curve truth = dense({{110, 60}, {320, 300}, {320, 380}, {320, 300}, {530, 60}});
  EXPECT_LT(frechet(traced->ranked.front(), truth), 22.0F);
}

TEST(Fold, IsNoneWhereTwoEndsShow) {
  // A rope whose end crosses it: the stub beyond the crossing is its end.
  const Curve loop = curve_of([](double t) {
    const double angle = 6.2831853 * t;
    return std::pair{320 + 90 * std::sin(angle), 210 - 90 * std::cos(angle)};
  });
  Curve rope{{60, 120}};
  rope.insert(rope.end(), loop.begin(), loop.end());
  rope.emplace_back(420, 120);
  const auto traced = path::trace(Canvas().stroke(rope, kWidthPx).frame());
  ASSERT_TRUE(traced);
  const path::Path& path = traced->ranked.front();
  const auto passes = std::count_if(path.points_px.begin(), path.points_px.end(),
                                    [](const Vector2f& p) { return p.x() > 400 && p.y() < 126; });
  EXPECT_LT(passes, 30) << "the stub is walked once";
}

TEST(Fold, IsNoneAtAnArmOfACross) {
  const Canvas canvas =
      Canvas().stroke({{100, 240}, {540, 240}}, kWidthPx).stroke({{320, 60}, {320, 420}}, kWidthPx);
  const auto traced = path::trace(canvas.frame());
  ASSERT_TRUE(traced);
  float length = 0;
  const auto& points = traced->ranked.front().points_px;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  EXPECT_LT(length, 1.3F * (440 + 360) + 300) << "no arm is walked back";
}

}  // namespace
}  // namespace flowdlo::test
