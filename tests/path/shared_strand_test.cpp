// Two strands that lie on or beside each other between crowded crossings look like one strand.
#include <gtest/gtest.h>

#include "canvas.hpp"
#include "path/path.hpp"

namespace flowdlo::test {
namespace {

// A smooth curve (Catmull-Rom) through the points.
Curve through(const std::vector<Vector2f>& points) {
  Curve curve;
  const auto at = [&](int i) {
    return points[static_cast<std::size_t>(std::clamp(i, 0, static_cast<int>(points.size()) - 1))];
  };
  for (int i = 0; i + 1 < static_cast<int>(points.size()); ++i) {
    const Vector2f a = at(i - 1);
    const Vector2f b = at(i);
    const Vector2f c = at(i + 1);
    const Vector2f d = at(i + 2);
    for (float t = 0; t < 1; t += 0.05F) {
      const Vector2f p = 0.5F * (2 * b + t * (c - a) + t * t * (2 * a - 5 * b + 4 * c - d) +
                                 t * t * t * (3 * b - a - 3 * c + d));
      curve.emplace_back(static_cast<int>(std::lround(p.x())),
                         static_cast<int>(std::lround(p.y())));
    }
  }
  return curve;
}

// Comes from the upper left, shares a stretch with its own later turn right before a crossing of
// three strands, and ends inside the upper left loop.
Curve knot() {
  return through({{158, 61},  {200, 60},  {240, 70},  {272, 85},  {302, 112}, {325, 146},
                  {339, 181}, {348, 221}, {350, 264}, {346, 308}, {338, 350}, {325, 388},
                  {301, 424}, {269, 455}, {232, 479}, {192, 491}, {155, 491}, {116, 477},
                  {83, 450},  {64, 413},  {60, 371},  {73, 330},  {99, 296},  {133, 272},
                  {168, 257}, {209, 252}, {252, 253}, {296, 257}, {339, 259}, {382, 256},
                  {423, 243}, {457, 222}, {480, 188}, {484, 146}, {467, 109}, {433, 85},
                  {391, 83},  {354, 101}, {330, 135}, {324, 176}, {333, 217}, {353, 254},
                  {380, 286}, {411, 316}, {441, 346}, {468, 379}, {487, 417}, {496, 458},
                  {490, 501}, {470, 539}, {436, 565}, {394, 576}, {352, 570}, {314, 549},
                  {285, 517}, {266, 479}, {254, 438}, {249, 396}, {246, 353}, {244, 310},
                  {241, 268}, {234, 227}, {223, 186}, {208, 148}});
}

TEST(SharedStrand, StretchBeforeACrowdedCrossingIsPassedTwice) {
  const Curve rope = knot();
  const Canvas canvas = Canvas(720, 860).stroke(rope, 21);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  EXPECT_LT(frechet(traced->ranked.front(), rope), 24.0F);
}

TEST(SharedStrand, MirroredOneAsWell) {
  Curve rope = knot();
  for (cv::Point& p : rope) p.x = 719 - p.x;
  const Canvas canvas = Canvas(720, 860).stroke(rope, 21);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  EXPECT_LT(frechet(traced->ranked.front(), rope), 24.0F);
}

}  // namespace
}  // namespace flowdlo::test
