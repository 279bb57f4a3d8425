#include <gtest/gtest.h>

#include <cmath>

#include "canvas.hpp"
#include "path/path.hpp"

namespace flowdlo::test {
namespace {

// In from the left, once around, out to the right: one crossing at the bottom of the loop.
Curve loop() {
  return curve_of([](double t) {
    const double angle = 2 * kPi * (t - 0.5);
    return std::pair{320 + 460 * (t - 0.5) - 150 * std::sin(angle) * 1.4,
                     250 + 120 * std::cos(angle)};
  });
}

Curve figure_eight() {
  return curve_of([](double t) {
    const double angle = -1.0 + (2 * kPi - 0.6) * t;
    return std::pair{320 + 220 * std::sin(angle), 240 + 130 * std::sin(2 * angle)};
  });
}

TEST(Crossing, PathGoesStraightOnAndCoversTheLoop) {
  const Canvas canvas = Canvas().stroke(loop(), 12);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  EXPECT_LT(frechet(traced->ranked.front(), loop()), 12.0F);
  EXPECT_GT(traced->margin, 0.5F);
}

TEST(Crossing, FigureEightIsCrossedNotReflected) {
  const Canvas canvas = Canvas().stroke(figure_eight(), 10);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  EXPECT_LT(frechet(traced->ranked.front(), figure_eight()), 11.0F);
}

TEST(Crossing, OverhandLoopWithThreeCrossingsIsFollowed) {
  const Curve knot = curve_of([](double t) {  // an open trefoil
    const double angle = 0.5 + 2 * kPi * t * 0.9;
    return std::pair{320 + 70 * (std::sin(angle) + 2 * std::sin(2 * angle)),
                     240 + 70 * (std::cos(angle) - 2 * std::cos(2 * angle))};
  });
  const Canvas canvas = Canvas().stroke(knot, 10);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  EXPECT_LT(frechet(traced->ranked.front(), knot), 12.0F);
}

TEST(Crossing, FlatOneIsStillACrossing) {  // two forks with a bridge that both strands share
  for (const double angle : {0.7, 0.5, 0.35}) {
    const Curve curve = curve_of([angle](double t) {  // a drop whose ends cross at this angle
      const double s = 2 * t - 1;
      const double side = std::sin(kPi * s) * 150 * std::tan(0.5 * angle);
      return std::pair{60 + 500 * (1 - s * s) + 20, 240 + side + 60 * s * s * s * 0.2};
    });
    const Canvas canvas = Canvas().stroke(curve, 12);

    const auto traced = path::trace(canvas.frame());

    ASSERT_TRUE(traced) << angle;
    EXPECT_LT(frechet(traced->ranked.front(), curve), 18.0F) << angle;
  }
}

TEST(Crossing, FlatCrossOfTwoStrandsJoinedByALoop) {
  // Two lines cross at 25 degrees; a wide arc joins their right ends.
  Curve curve{{60, 190}};
  const Curve arc = curve_of([](double t) {
    const double angle = -0.5 * kPi + kPi * t;
    return std::pair{470 + 100 * std::cos(angle), 240 - 90 * std::sin(angle)};
  });
  curve.insert(curve.end(), arc.begin(), arc.end());
  curve.emplace_back(60, 290);
  Curve dense;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    for (int k = 1; k <= 60; ++k) {
      dense.push_back(curve[i - 1] + (curve[i] - curve[i - 1]) * k / 60);
    }
  }
  const Canvas canvas = Canvas().stroke(curve, 12);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  EXPECT_LT(frechet(traced->ranked.front(), dense), 14.0F);
}

TEST(Crossing, DepthTellsTwoRopesApartWhereBendingCannot) {
  // A cross whose four arms are alike: right angles on either pairing of neighbours cost the same
  // as each other, and depth says which arms are of one rope.
  const Curve upper = curve_of([](double t) {
    return std::pair{120 + 400 * t, 240 - 200 * std::abs(t - 0.5)};
  });
  const Curve lower = curve_of([](double t) {
    return std::pair{120 + 400 * t, 240 + 200 * std::abs(t - 0.5)};
  });
  Canvas canvas = Canvas().stroke(upper, 12).stroke(lower, 12);
  canvas.depth(lower, 14, 0.62F).depth(upper, 14, 0.50F);

  const auto traced = path::trace_ropes(canvas.frame(), 2);

  ASSERT_TRUE(traced);
  ASSERT_EQ(traced->ropes.size(), 2U);
  for (const path::Path& rope : traced->ropes) {  // both touch at their kinks
    EXPECT_EQ(rope.points_px.front().y() < 240, rope.points_px.back().y() < 240);
  }
}

TEST(Crossing, TouchingStrandsDoNotChangeSides) {
  Curve hairpin{{100, 150}, {200, 233}, {440, 233}};
  const Curve turn = curve_of([](double t) {
    const double angle = -0.5 * kPi + kPi * t;
    return std::pair{500 + 40 * std::cos(angle), 240 + 40 * std::sin(angle)};
  });
  hairpin.insert(hairpin.end(), turn.begin(), turn.end());
  hairpin.insert(hairpin.end(), {{440, 246}, {200, 246}, {100, 330}});
  const Canvas canvas = Canvas().stroke(hairpin, 13);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  const auto& points = traced->ranked.front().points_px;
  for (const Vector2f& p : points) {
    if (std::abs(p.x() - 320) > 1) continue;
    EXPECT_GT(std::abs(p.y() - 239.5F), 2.0F) << "each strand keeps to its side";
  }
  EXPECT_LT(distance_to(points, {100, 150}), 8.0F);
  EXPECT_LT(distance_to(points, {100, 330}), 8.0F);
  EXPECT_LT(distance_to(points, {540, 240}), 8.0F);
}

TEST(Crossing, AmbiguousJunctionLowersTheMargin) {
  const Canvas clear = Canvas().stroke(loop(), 12);
  // Four arms at right angles, the ends of a square loop: going straight and turning are close.
  const Canvas doubtful = Canvas().stroke({{320, 60},
                                           {320, 150},
                                           {322, 240},
                                           {390, 300},
                                           {460, 240},
                                           {390, 180},
                                           {322, 238},
                                           {320, 330},
                                           {320, 420}},
                                          12);

  const auto sure = path::trace(clear.frame());
  const auto unsure = path::trace(doubtful.frame());

  ASSERT_TRUE(sure);
  ASSERT_TRUE(unsure);
  EXPECT_LT(unsure->margin, sure->margin);
}

TEST(Crossing, AlternativesAreDistinctAndNoBetter) {
  const Canvas canvas = Canvas().stroke(figure_eight(), 10);

  const auto traced = path::trace(canvas.frame(), {.alternatives = 5});

  ASSERT_TRUE(traced);
  ASSERT_GT(traced->ranked.size(), 1U);
  EXPECT_LE(traced->ranked.size(), 6U);
  for (std::size_t a = 0; a < traced->ranked.size(); ++a) {
    EXPECT_TRUE(sound(traced->ranked[a], canvas.frame()));
    for (std::size_t b = a + 1; b < traced->ranked.size(); ++b) {
      EXPECT_NE(traced->ranked[a].points_px, traced->ranked[b].points_px);
      EXPECT_GE(traced->ranked[a].score, traced->ranked[b].score);
    }
  }
}

TEST(Crossing, NoAlternativesMeansOnePath) {
  const Canvas canvas = Canvas().stroke(figure_eight(), 10);

  const auto traced = path::trace(canvas.frame(), {.alternatives = 0});

  ASSERT_TRUE(traced);
  EXPECT_EQ(traced->ranked.size(), 1U);
}

}  // namespace
}  // namespace flowdlo::test
