#include "field/ridge.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "field/channel.hpp"
#include "field/region.hpp"

namespace flowdlo::field {
namespace {

/// A perfect field of a straight strand through `middle`.
Channels straight(float angle, const Eigen::Vector2f& middle) {
  Channels field({64, 64}, {});
  for (int v = 0; v < field.height(); ++v) {
    for (int u = 0; u < field.width(); ++u) {
      const Eigen::Vector2f off =
          Eigen::Vector2f(static_cast<float>(u), static_cast<float>(v)) - middle;
      const float across = off.dot(Eigen::Vector2f(-std::sin(angle), std::cos(angle)));
      const float near = across / (kCentreWidths * kRope_px);
      auto& at = field.at(v, u);
      at[kCentre] = std::exp(-near * near);
      at[kCos] = std::cos(2 * angle);
      at[kSin] = std::sin(2 * angle);
    }
  }
  return field;
}

TEST(Ridge, LiesOnTheAxisWithinAnEighthOfAPixelInEveryDirection) {
  for (float angle = 0; angle < 3.1F; angle += 0.3F) {
    const Eigen::Vector2f middle(31.3F, 30.8F);
    const auto points = ridges(straight(angle, middle));
    ASSERT_GT(points.size(), 40U) << angle;
    for (const RidgePoint& point : points) {
      if ((point.px - Eigen::Vector2f(32, 32)).cwiseAbs().maxCoeff() > 28) continue;  // the border
      const float off = (point.px - middle).dot(Eigen::Vector2f(-std::sin(angle), std::cos(angle)));
      EXPECT_LT(std::abs(off), 0.125F) << angle;
      EXPECT_LT(std::abs(std::sin(point.angle - angle)), 1e-3F);
    }
  }
}

TEST(Ridge, WhatIsFaintIsNone) {
  Channels field = straight(0.4F, {32, 32});
  for (int i = 0; i < field.size().area(); ++i) {
    for (float& channel : field.at(i / 64, i % 64)) channel *= 0.3F;
  }
  EXPECT_TRUE(ridges(field).empty());
}

TEST(Tips, OneAPeakHoweverFlat) {
  Channels field({64, 64}, {});
  const auto tip = [&](int u, int v) -> float& { return field.at(v, u)[kTip]; };
  for (int v = 20; v < 23; ++v) {
    for (int u = 30; u < 33; ++u) tip(u, v) = 0.9F;
  }
  tip(50, 50) = 0.75F;
  tip(5, 5) = 0.3F;
  const auto found = tips(field);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0], Eigen::Vector2f(30, 20));
  EXPECT_EQ(found[1], Eigen::Vector2f(50, 50));
}

}  // namespace
}  // namespace flowdlo::field
