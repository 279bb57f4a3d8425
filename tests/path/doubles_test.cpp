#include "path/doubles.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "canvas.hpp"
#include "path/graph.hpp"
#include "path/region.hpp"
#include "path/thinning.hpp"

namespace flowdlo::test {
namespace {

// A hairpin whose strands touch from x = 220 to x = 440; its bend, on the right, is open. One end
// lies at x = 80. The other one stops beside it at x = 220, or parts from it to the upper left.
// `apart_px` less than the width: seen aslant, one hides part of the other.
Curve hairpin(int width_px, bool parts, int apart_px) {
  const int upper = 240 - apart_px / 2;
  const int lower = upper + apart_px;
  const double radius = 4.0 * width_px;
  Curve curve;
  if (parts) {
    for (int x = 80; x < 220; x += 4) {
      curve.emplace_back(x, upper - (220 - x) * (220 - x) / 200);
    }
  }
  curve.emplace_back(220, upper);
  curve.emplace_back(440, upper);
  const double middle = 0.5 * (upper + lower);
  for (double t = 0; t <= 1; t += 0.02) {
    const double open = 0.5 * apart_px + (radius - 0.5 * apart_px) * t * t * (3 - 2 * t);
    curve.emplace_back(static_cast<int>(440 + 80 * t), static_cast<int>(middle - open));
  }
  for (double angle = -0.5 * kPi; angle <= 0.5 * kPi; angle += 0.05) {
    curve.emplace_back(static_cast<int>(520 + radius * std::cos(angle)),
                       static_cast<int>(middle + radius * std::sin(angle)));
  }
  for (double t = 1; t >= 0; t -= 0.02) {
    const double open = 0.5 * apart_px + (radius - 0.5 * apart_px) * t * t * (3 - 2 * t);
    curve.emplace_back(static_cast<int>(440 + 80 * t), static_cast<int>(middle + open));
  }
  curve.emplace_back(440, lower);
  curve.emplace_back(80, lower);
  return curve;
}

// A ring whose ends lie beside each other for `beside` radians.
Curve overlapping_ring(int width_px, double beside) {
  return curve_of([&](double t) {
    const double angle = (2 * kPi + beside) * t;
    const double radius = 130 + width_px * angle / (2 * kPi);
    return std::pair{320 + radius * std::cos(angle), 240 + radius * std::sin(angle)};
  });
}

Curve ring(double radius) {
  return curve_of([radius](double t) {
    return std::pair{320 + radius * std::cos(2 * kPi * t), 240 + radius * std::sin(2 * kPi * t)};
  });
}

std::size_t doubles_in(const Canvas& canvas) {
  const auto region = path::clean(canvas.frame());
  const path::Graph graph = path::make_graph(path::thin(region->mask), *region);
  return path::find_doubles(graph, *region, canvas.frame()).lines.size();
}

class Hairpin : public testing::TestWithParam<int> {};

TEST_P(Hairpin, WhoseEndStopsBesideTheOtherStrandIsWalkedOnBoth) {
  const int width_px = GetParam();
  const Curve curve = hairpin(width_px, false, width_px);
  const Canvas canvas = Canvas().stroke(curve, width_px);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  ASSERT_TRUE(sound(traced->ranked.front(), canvas.frame()));
  EXPECT_LT(frechet(traced->ranked.front(), dense(curve)), 2.0F + static_cast<float>(width_px));
}

TEST_P(Hairpin, WhoseEndsPartIsWalkedOnBoth) {
  const int width_px = GetParam();
  const Curve curve = hairpin(width_px, true, width_px);
  const Canvas canvas = Canvas().stroke(curve, width_px);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  EXPECT_LT(frechet(traced->ranked.front(), dense(curve)), 2.0F + static_cast<float>(width_px));
}

TEST_P(Hairpin, SeenAslantWhoseEndsPartIsWalkedOnBoth) {
  const int width_px = GetParam();
  const Curve curve = hairpin(width_px, true, (width_px + 1) / 2);
  const Canvas canvas = Canvas().stroke(curve, width_px);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  EXPECT_LT(frechet(traced->ranked.front(), dense(curve)), 3.0F + static_cast<float>(width_px));
}

TEST(Doubles, SeenAslantEndAtTheStepWhereAStrandStops) {
  for (const int width_px : {9, 11, 15}) {
    const Curve curve = hairpin(width_px, false, (width_px + 1) / 2);
    const auto traced = path::trace(Canvas().stroke(curve, width_px).frame());
    ASSERT_TRUE(traced);
    EXPECT_LT(frechet(traced->ranked.front(), dense(curve)), 3.0F + static_cast<float>(width_px))
        << width_px;
  }
}

TEST(Doubles, FillTheStemOfALoopWhoseEndsLieTogether) {
  for (const int width_px : {7, 11}) {
    Curve curve = hairpin(width_px, false, width_px);
    curve.insert(curve.begin(), {80, curve.front().y});
    const auto traced = path::trace(Canvas().stroke(curve, width_px).frame());
    ASSERT_TRUE(traced);
    EXPECT_LT(frechet(traced->ranked.front(), dense(curve)), 3.0F + static_cast<float>(width_px))
        << width_px;
  }
}

TEST(Doubles, AreNotFoundInTheStemOfALoopOfOneStrand) {
  const Canvas canvas = Canvas()
                            .stroke({{60, 240}, {300, 240}}, 9)
                            .stroke(ring(80), 9)
                            .stroke({{60, 240}, {20, 200}}, 9)
                            .stroke({{60, 240}, {20, 280}}, 9);
  EXPECT_EQ(doubles_in(canvas), 0U);
}

INSTANTIATE_TEST_SUITE_P(Widths, Hairpin, testing::Values(3, 5, 7, 11));

TEST(Doubles, TellTheEndsOfARingThatOverlapsItself) {
  const Curve curve = overlapping_ring(9, 0.8);
  const Canvas canvas = Canvas().stroke(curve, 9);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  EXPECT_FALSE(traced->ranked.front().ring);
  EXPECT_LT(frechet(traced->ranked.front(), curve), 11.0F);
}

TEST(Doubles, AreNotFoundWhereARopeGrowsWiderTowardsTheCamera) {
  Canvas canvas;
  for (int x = 60; x < 580; ++x) {
    canvas.stroke({{x, 240}, {x + 1, 240}}, 8 + x / 40);
  }
  EXPECT_EQ(doubles_in(canvas), 0U);
}

TEST(Doubles, AreNotFoundAtAFlatCrossing) {
  const Canvas canvas =
      Canvas().stroke({{60, 200}, {580, 280}}, 9).stroke({{60, 280}, {580, 200}}, 9);
  EXPECT_EQ(doubles_in(canvas), 0U);
}

TEST(Ring, WithoutEndsIsSaidToBeOne) {
  const auto traced = path::trace(Canvas().stroke(ring(120), 9).frame());
  ASSERT_TRUE(traced);
  EXPECT_TRUE(traced->ranked.front().ring);
}

TEST(HiddenEnds, AreNoneWhereBothTipsShow) {
  const auto traced = path::trace(Canvas().stroke({{100, 240}, {540, 240}}, 9).frame());
  ASSERT_TRUE(traced);
  EXPECT_FALSE(traced->ranked.front().ring);
  EXPECT_EQ(traced->ranked.front().hidden_ends, 0);
}

}  // namespace
}  // namespace flowdlo::test
