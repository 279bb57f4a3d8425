#include "synth/cord.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "synth/synthetic_frame.hpp"

namespace flowdlo::synth {
namespace {

constexpr double kRadius_m = 0.004;

/// A quarter of a circle, out of the plane on its way.
Curve bent() {
  std::vector<Vector3d> points;
  for (int i = 0; i <= 400; ++i) {
    const double angle = 1.5 * i / 400;
    points.emplace_back(0.1 * std::cos(angle), 0.1 * std::sin(angle), 0.5 + 0.02 * angle);
  }
  return respaced(points, 0.5 * kRadius_m);
}

double distance_to(const std::vector<Vector3d>& line, const Vector3d& p) {
  double least_m = 1e9;
  for (const Vector3d& q : line) least_m = std::min(least_m, (p - q).norm());
  return least_m;
}

Cord laid(int strands) {
  Cord cord;
  cord.strands = strands;
  return cord;
}

TEST(Cord, StrandsFillTheRopeAndTouchEachOther) {
  const Curve curve = bent();
  for (const int strands : {2, 3, 4}) {
    const Cord cord = laid(strands);
    const double strand_m = cord.strand_radii() * kRadius_m;
    const auto axes = strand_axes(cord, curve, kRadius_m);
    ASSERT_EQ(axes.size(), static_cast<std::size_t>(strands));
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
      const double out_m = (axes[0][i] - curve.points[i]).norm();
      EXPECT_NEAR(out_m + strand_m, kRadius_m, 1e-9);
      EXPECT_NEAR((axes[0][i] - axes[1][i]).norm(), 2 * strand_m, 1e-9);
    }
  }
}

TEST(Cord, AStrandComesBackToItsSideAfterATurn) {
  std::vector<Vector3d> points;
  for (int i = 0; i <= 300; ++i) points.emplace_back(0.001 * i, 0, 0.5);
  const Curve curve = respaced(points, 0.5 * kRadius_m);
  Cord cord = laid(2);
  cord.turn_radii = 10;
  const auto axes = strand_axes(cord, curve, kRadius_m);
  const auto turn = static_cast<std::size_t>(std::lround(10 * kRadius_m / curve.step_m));
  const Vector3d out = axes[0][20] - curve.points[20];
  EXPECT_NEAR((axes[0][20 + turn] - curve.points[20 + turn] - out).norm(), 0, 0.1 * kRadius_m);
  EXPECT_NEAR((axes[0][20 + turn / 2] - curve.points[20 + turn / 2] + out).norm(), 0,
              0.1 * kRadius_m);
}

TEST(Cord, CarriedAcrossStaysAcrossAndDoesNotTurn) {
  const Curve curve = bent();
  const auto across = carried_across(curve);
  for (std::size_t i = 1; i + 1 < across.size(); ++i) {
    const Vector3d tangent = (curve.points[i + 1] - curve.points[i - 1]).normalized();
    EXPECT_NEAR(across[i].dot(tangent), 0, 1e-9);
    EXPECT_LT((across[i] - across[i - 1]).norm(), 0.03);
  }
}

TEST(Cord, ATubesPatternsHaveBothColours) {
  for (const Pattern pattern : {Pattern::kTracers, Pattern::kSpeckles, Pattern::kBands}) {
    Cord cord;
    cord.pattern = pattern;
    cord.others = 1;
    cord.share = 0.5;
    cord.other_bgr = {200, 200, 200};
    int other = 0;
    for (int i = 0; i < 1000; ++i) {
      const auto color = color_at(cord, {0, 0.05 * i, 0.1});
      other += color.x() > 100 ? 1 : 0;
    }
    EXPECT_GT(other, 50);
    EXPECT_LT(other, 950);
  }
}

TEST(Cords, AreTheSameSceneOfOtherRopes) {
  const auto plain = make_frame(Split::kWide, Part::kTraining, 0, 111, {.dense = true});
  const auto cords =
      make_frame(Split::kWide, Part::kTraining, 0, 111, {.dense = true, .cords = true});
  const auto again = make_frame(Split::kWide, Part::kTraining, 0, 111, {.cords = true});
  ASSERT_TRUE(plain && cords && again);
  EXPECT_EQ(cords->folder.color_bgr, again->folder.color_bgr);
  EXPECT_EQ(cords->folder.depth_m, again->folder.depth_m);
  EXPECT_EQ(cords->truth(), plain->truth());
  EXPECT_EQ(cords->meta.material, "cord");
  EXPECT_NE(cords->folder.color_bgr, plain->folder.color_bgr);
}

/// Of a scene whose rope is laid: what its strands show is within the rope, and not all of it.
TEST(Cords, LaidRopesLieWithinTheirRadius) {
  int laid_ones = 0;
  for (std::uint64_t index = 100; index < 112; ++index) {
    const auto cords = make_frame(Split::kWide, Part::kTraining, 0, index,
                                  {.color = false, .dense = true, .cords = true});
    const auto plain =
        make_frame(Split::kWide, Part::kTraining, 0, index, {.color = false, .dense = true});
    ASSERT_TRUE(cords && plain);
    if (cords->truth() != plain->truth()) continue;  // what shows decides which attempt is taken
    const FrameFolder& folder = cords->folder;
    int inside = 0;
    int gone = 0;
    for (std::size_t p = 0; p < folder.mask.size(); ++p) {
      gone += plain->dense->mask[p] != 0 && cords->dense->mask[p] == 0 ? 1 : 0;
      if (cords->dense->mask[p] == 0) continue;
      const double z = static_cast<double>(cords->dense->depth_m[p]);
      const auto u = static_cast<double>(p % static_cast<std::size_t>(folder.width));
      const auto v = static_cast<double>(p / static_cast<std::size_t>(folder.width));
      const Vector3d at((u - folder.intrinsics.cx) * z / folder.intrinsics.fx,
                        (v - folder.intrinsics.cy) * z / folder.intrinsics.fy, z);
      EXPECT_LT(distance_to(cords->dense->curves[0].points, at), 1.2 * cords->ropes[0].radius_m);
      if (++inside == 200) break;
    }
    laid_ones += gone > 0 ? 1 : 0;
  }
  EXPECT_GE(laid_ones, 2);
}

}  // namespace
}  // namespace flowdlo::synth
