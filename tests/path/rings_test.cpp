#include "path/rings.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "canvas.hpp"
#include "path/graph.hpp"
#include "path/region.hpp"
#include "path/thinning.hpp"

namespace flowdlo::test {
namespace {

constexpr double kRadius = 130;

Vector2f on_circle(double angle) {
  return {static_cast<float>(320 + kRadius * std::cos(angle)),
          static_cast<float>(240 + kRadius * std::sin(angle))};
}

// Begins at `angle` and ends beside it, after a turn and `beside` radians.
Curve overlapping(int width_px, double angle, double beside) {
  return curve_of([&](double t) {
    const double turned = (2 * kPi + beside) * t;
    const double radius = kRadius + width_px * turned / (2 * kPi);
    return std::pair{320 + radius * std::cos(angle + turned),
                     240 + radius * std::sin(angle + turned)};
  });
}

Curve circle() {
  return curve_of([](double t) {
    return std::pair{320 + kRadius * std::cos(2 * kPi * t), 240 + kRadius * std::sin(2 * kPi * t)};
  });
}

float nearest_end(const path::Path& path, const Vector2f& p) {
  return std::min((path.points_px.front() - p).norm(), (path.points_px.back() - p).norm());
}

class Overlap : public testing::TestWithParam<int> {};

TEST_P(Overlap, TooBriefToBeCutIsPassedTwice) {
  const int width_px = GetParam();
  for (const double angle : {0.4, 1.9, 3.1, 5.0}) {
    const Curve curve = overlapping(width_px, angle, 0.12);
    const auto traced = path::trace(Canvas().stroke(curve, width_px).frame());
    ASSERT_TRUE(traced);
    EXPECT_LT(frechet(traced->ranked.front(), curve), 4.0F + static_cast<float>(width_px)) << angle;
  }
}

INSTANTIATE_TEST_SUITE_P(Widths, Overlap, testing::Values(4, 5, 7));

TEST(Rings, KeepTheStrandsOfAnOverlapOnTheirSides) {
  const int width_px = 7;
  const Curve curve = overlapping(width_px, 0.9, 0.3);
  const Canvas canvas = Canvas().stroke(curve, width_px);
  const auto region = path::clean(canvas.frame());
  path::Graph graph = path::make_graph(path::thin(region->mask), *region);
  path::open_rings(graph, *region);

  std::vector<Vector2f> ends;
  for (const path::Segment& segment : graph.segments) {
    if (!segment.alive || !segment.ring()) continue;
    ends = {segment.points_px.front(), segment.points_px.back()};
  }

  ASSERT_EQ(ends.size(), 2U);
  const Vector2f middle(320.0F - static_cast<float>(region->offset_px.x),
                        240.0F - static_cast<float>(region->offset_px.y));
  const float apart = std::abs((ends[0] - middle).norm() - (ends[1] - middle).norm());
  EXPECT_NEAR(apart, static_cast<float>(width_px), 3.0F);
}

TEST(Rings, ThinOnesOpenAtTheirNotch) {
  Canvas canvas = Canvas().stroke(circle(), 6);
  const Vector2f at = on_circle(1.0);
  const Vector2f out = (at - Vector2f(320, 240)).normalized();
  for (const float side : {-1.0F, 1.0F}) {
    const Vector2f edge = at + side * 3.0F * out;
    canvas.erase({static_cast<int>(std::lround(edge.x())) - 1,
                  static_cast<int>(std::lround(edge.y())) - 1, 3, 3});
  }

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  EXPECT_LT(nearest_end(traced->ranked.front(), at), 5.0F);
}

TEST(Rings, WithoutEndsStayAsTheyAre) {
  const Canvas canvas = Canvas().stroke(circle(), 9);
  const auto region = path::clean(canvas.frame());
  path::Graph graph = path::make_graph(path::thin(region->mask), *region);
  const auto before = graph.segments.front().points_px.size();

  path::open_rings(graph, *region);

  EXPECT_EQ(graph.segments.front().points_px.size(), before);
}

TEST(Rings, OpenLinesAreLeftAlone) {
  const Canvas canvas = Canvas().stroke({{100, 240}, {540, 240}}, 9);
  const auto region = path::clean(canvas.frame());
  path::Graph graph = path::make_graph(path::thin(region->mask), *region);
  const std::vector<Vector2f> before = graph.segments.front().points_px;

  path::open_rings(graph, *region);

  EXPECT_EQ(graph.segments.front().points_px, before);
}

}  // namespace
}  // namespace flowdlo::test
