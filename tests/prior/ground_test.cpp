#include "prior/ground.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/camera.hpp"
#include "prior/drawn_rope.hpp"

namespace flowdlo::prior {
namespace {

using testing::draw_rope;
using testing::DrawnRope;
using testing::kRadius_m;

constexpr double kFar_m = 1;

/// A metre before the camera, 7 px wide: straight across the image, at `tilt` metres of depth a
/// metre aside.
DrawnRope straight(double tilt) {
  lab::Curve3 curve;
  for (int i = 0; i <= 200; ++i) {
    const double x = -0.3 + 0.6 * i / 200;
    curve.emplace_back(x, 0.02, kFar_m + tilt * x);
  }
  return draw_rope(curve);
}

/// A ground that the whole rope lies on, seen as a camera sees it whose window of `window_px` mixes
/// rope and ground.
void lay_down(double tilt, int window_px, DrawnRope& rope) {
  const double rise = kRadius_m * std::sqrt(1 + tilt * tilt);
  auto& depth_m = rope.image.depth_m;
  const auto& camera = rope.image.camera;
  for (int v = 0; v < rope.image.height; ++v) {
    for (int u = 0; u < rope.image.width; ++u) {
      const double x = (static_cast<double>(u) - static_cast<double>(camera.cx)) /
                       static_cast<double>(camera.fx);
      const double z = (kFar_m + rise) / (1 - tilt * x);  // of the plane kFar_m + rise + tilt x z
      float& at = depth_m[rope.index(u, v)];
      at = rope.image.mask[rope.index(u, v)] > 127 ? at : static_cast<float>(z);
    }
  }
  const auto sharp = depth_m;
  for (int v = window_px; v + window_px < rope.image.height; ++v) {
    for (int u = 0; u < rope.image.width; ++u) {
      double sum = 0;
      for (int k = -window_px; k <= window_px; ++k) {
        sum += static_cast<double>(sharp[rope.index(u, v + k)]);
      }
      depth_m[rope.index(u, v)] = static_cast<float>(sum / (2 * window_px + 1));
    }
  }
}

/// Mean of how much deeper than the true axis the inner nodes are, metres.
double bias_m(const DrawnRope& rope, double tilt) {
  const auto prior = rope.refined();
  EXPECT_TRUE(prior) << prior.error().message;
  if (!prior) return 1;
  double sum = 0;
  int count = 0;
  for (int i = 8; i < kNodes - 8; ++i) {
    const Point3& node = prior->nodes[static_cast<std::size_t>(i)];
    sum += static_cast<double>(node.z) - (kFar_m + tilt * static_cast<double>(node.x));
    ++count;
  }
  return sum / count;
}

TEST(Ground, LeavesAClearDepthAsItIs) {
  DrawnRope rope = straight(0);
  const auto before = rope.refined();
  lay_down(0, 0, rope);
  const auto after = rope.refined();
  ASSERT_TRUE(before && after);
  for (std::size_t i = 0; i < kNodes; ++i) EXPECT_EQ(before->nodes[i], after->nodes[i]);
}

TEST(Ground, BringsForwardWhatAWindowPulledBack) {
  for (const double tilt : {0.0, 0.5}) {
    DrawnRope rope = straight(tilt);
    lay_down(tilt, 5, rope);
    // Its ridge comes out half a radius and more too deep.
    const float ridge_m = rope.image.depth_m[rope.index(320, 252)];
    EXPECT_GT(static_cast<double>(ridge_m), kFar_m - 0.5 * kRadius_m);
    EXPECT_LT(std::abs(bias_m(rope, tilt)), 0.12 * kRadius_m) << "tilt " << tilt;
  }
}

TEST(Ground, TellsNothingOfARopeInTheAir) {  // the wall is a metre behind it
  DrawnRope rope = straight(0);
  EXPECT_LT(std::abs(bias_m(rope, 0)), 0.05 * kRadius_m);
}

TEST(Ground, TellsNothingWhereWhatIsBesideIsNearer) {
  DrawnRope rope = straight(0);
  for (std::size_t i = 0; i < rope.image.depth_m.size(); ++i) {
    if (rope.image.mask[i] <= 127) rope.image.depth_m[i] = 0.95F;  // it lies in a groove
  }
  EXPECT_LT(std::abs(bias_m(rope, 0)), 0.05 * kRadius_m);
}

TEST(Ground, IsUnknownWhereTheMaskEndsOnOneSideOnly) {
  DrawnRope rope = straight(0);
  lay_down(0, 5, rope);
  const auto cloud = evidence::unproject(rope.frame());
  for (int v = 253; v < rope.image.height; ++v) {  // no depth below the rope
    for (int u = 0; u < rope.image.width; ++u) {
      if (rope.image.mask[rope.index(u, v)] <= 127) rope.image.depth_m[rope.index(u, v)] = 0;
    }
  }
  const Strip strip = make_strip(rope.path.points_px, rope.width_px, rope.frame(), cloud);
  for (const Station& station : strip.stations) EXPECT_EQ(station.ground_m, 0);
  const std::vector<double> axis_m(strip.stations.size(), kFar_m);
  for (const double deep_m : too_deep_m(strip, axis_m, 0.006F)) EXPECT_EQ(deep_m, 0);
}

TEST(Ground, GoesByTheRadiusAndSmoothlyAlongTheRope) {
  DrawnRope rope = straight(0);
  lay_down(0, 0, rope);
  const auto cloud = evidence::unproject(rope.frame());
  const Strip strip = make_strip(rope.path.points_px, rope.width_px, rope.frame(), cloud);
  std::vector<double> axis_m(strip.stations.size(), kFar_m);
  for (std::size_t i = axis_m.size() / 2; i < axis_m.size(); ++i) axis_m[i] += kRadius_m;
  const auto deep_m = too_deep_m(strip, axis_m, static_cast<float>(kRadius_m));
  ASSERT_EQ(deep_m.size(), axis_m.size());
  EXPECT_NEAR(deep_m[axis_m.size() / 8], 0, 1e-6);
  EXPECT_NEAR(deep_m[axis_m.size() * 7 / 8], kRadius_m, 0.1 * kRadius_m);
  for (std::size_t i = 1; i < deep_m.size(); ++i) {
    EXPECT_LT(std::abs(deep_m[i] - deep_m[i - 1]), 0.2 * kRadius_m);
  }
}

}  // namespace
}  // namespace flowdlo::prior
