// Hand-made ropes of 6 mm radius, seen by a camera of 600 px focal length.
#include "prior/refined_prior.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "geometry/polyline.hpp"
#include "prior/drawn_rope.hpp"

namespace flowdlo::prior {
namespace {

using testing::crossing_line;
using testing::draw_rope;
using testing::DrawnRope;
using testing::erase_depth;
using testing::farthest;
using testing::kRadius_m;
using testing::refined;
using testing::straight_line;

std::vector<std::size_t> nodes_near(const Prior& prior, double x, double y, double reach_m) {
  std::vector<std::size_t> nodes;
  for (std::size_t i = 0; i < prior.nodes.size(); ++i) {
    const Point3& p = prior.nodes[i];
    if (std::hypot(static_cast<double>(p.x) - x, static_cast<double>(p.y) - y) < reach_m) {
      nodes.push_back(i);
    }
  }
  return nodes;
}

TEST(Refine, PutsNodesOnTheAxisOfATubeSeenFaceOn) {
  const DrawnRope rope = draw_rope(straight_line());
  EXPECT_LT(farthest(refined(rope), rope.curve), 0.1 * kRadius_m);
}

TEST(Refine, PutsNodesOnTheAxisOfATubeThatRunsTowardsTheCamera) {  // at 45 degrees
  const DrawnRope rope = draw_rope({{-0.15, 0, 0.75}, {0.1, 0.02, 0.5}});
  EXPECT_LT(farthest(refined(rope), rope.curve), 0.15 * kRadius_m);
}

// Turns until it runs at 74 degrees to the image: the axis lies 3 radii and more behind the
// surface.
TEST(Refine, PutsNodesOnTheAxisOfATubeThatTurnsAwayFromTheCamera) {
  lab::Curve3 curve{{-0.1, 0, 0.42}};
  for (double turn = 0; turn <= 1.3; turn += 0.02) {
    curve.push_back(curve.back() + 0.006 * Eigen::Vector3d(std::cos(turn), 0.1, std::sin(turn)));
  }
  const DrawnRope rope = draw_rope(curve);
  EXPECT_LT(farthest(refined(rope), rope.curve), 0.5 * kRadius_m);
}

TEST(Refine, PutsNodesOnTheAxisNearTheImagesCorner) {
  const DrawnRope rope = draw_rope({{-0.28, -0.2, 0.6}, {-0.1, -0.21, 0.6}});
  EXPECT_LT(farthest(refined(rope), rope.curve), 0.1 * kRadius_m);
}

TEST(Refine, FollowsABendInDepth) {
  lab::Curve3 curve;
  for (double x = -0.2; x <= 0.2; x += 0.002)
    curve.emplace_back(x, 0.03 * x, 0.6 + 0.02 * std::sin(30 * x));
  const DrawnRope rope = draw_rope(curve);
  EXPECT_LT(farthest(refined(rope), rope.curve), 0.15 * kRadius_m);
}

TEST(Refine, SpacesNodesEvenlyInSpace) {
  const Prior prior = refined(draw_rope({{-0.15, 0, 0.75}, {0.0, 0, 0.6}, {0.15, 0.1, 0.6}}));
  const auto lengths = geometry::segment_lengths(prior.nodes);
  const auto [least, most] = std::minmax_element(lengths.begin(), lengths.end());
  EXPECT_LT(*most, 1.02 * *least);
}

TEST(Refine, IsNotMisledByFlyingPixelsAtTheRim) {
  DrawnRope rope = draw_rope(straight_line());
  std::mt19937 random(3);
  const auto before = rope.image.mask;
  for (int v = 1; v + 1 < rope.image.height; ++v) {
    for (int u = 0; u < rope.image.width; ++u) {
      const bool rim = before[rope.index(u, v - 1)] != before[rope.index(u, v + 1)];
      if (!rim || random() % 10 >= 4) continue;
      const float share = static_cast<float>(random() % 1000) / 1000;
      rope.image.depth_m[rope.index(u, v)] = 0.6F + 1.4F * share;
    }
  }
  EXPECT_LT(farthest(refined(rope), rope.curve), 0.2 * kRadius_m);
}

// The wall is 1.4 m behind the rope; 7 of its 12 pixels across show it.
TEST(Refine, StaysOnTheRopeWhereDepthAndMaskLieBesideEachOther) {
  DrawnRope rope = draw_rope(straight_line());
  const auto before = rope.image.depth_m;
  for (int v = 7; v < rope.image.height; ++v) {
    for (int u = 0; u < rope.image.width; ++u) {
      rope.image.depth_m[rope.index(u, v)] = before[rope.index(u, v - 7)];
    }
  }
  EXPECT_LT(farthest(refined(rope), rope.curve), kRadius_m);
}

TEST(Refine, AveragesNoiseAndQuantisationAway) {
  DrawnRope rope = draw_rope(straight_line());
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0, 0.003F);
  for (float& depth_m : rope.image.depth_m) {
    depth_m = std::round((depth_m + noise(random)) * 500) / 500;  // steps of 2 mm
  }
  EXPECT_LT(farthest(refined(rope), rope.curve), 0.35 * kRadius_m);
}

TEST(Refine, BridgesAStretchWithoutDepth) {
  DrawnRope rope = draw_rope({{-0.15, 0, 0.7}, {0.15, 0, 0.5}});
  erase_depth(rope, 270, 370);
  EXPECT_LT(farthest(refined(rope), rope.curve), 0.3 * kRadius_m);
}

TEST(Refine, GoesOnStraightBeyondTheLastDepth) {
  DrawnRope rope = draw_rope({{-0.15, 0, 0.7}, {0.15, 0, 0.5}});
  erase_depth(rope, 470, 640);
  EXPECT_LT(farthest(refined(rope), rope.curve), 0.5 * kRadius_m);
}

TEST(Refine, TakesTheRadiusFromTheWholeRopeWhereABarCutsIt) {
  const lab::Bar bar{
      .point_px = {300, 240}, .direction = {0.5, 0.866}, .half_width_px = 30, .depth_m = 0.4};
  const DrawnRope rope = draw_rope(straight_line(), {bar});
  EXPECT_LT(farthest(refined(rope), rope.curve), 0.15 * kRadius_m);
}

TEST(Refine, IsNotPushedTooDeepByAMaskThatBleedsOntoTheWall) {
  DrawnRope rope = draw_rope(straight_line());
  const auto before = rope.image.mask;
  const int grow = 3;  // the mask is half as wide again
  for (int v = grow; v + grow < rope.image.height; ++v) {
    for (int u = 0; u < rope.image.width; ++u) {
      for (int dv = -grow; dv <= grow; ++dv) {
        if (before[rope.index(u, v + dv)] != 0) rope.image.mask[rope.index(u, v)] = 255;
      }
    }
  }
  rope.width_px += 2 * grow;
  EXPECT_LT(farthest(refined(rope), rope.curve), 0.25 * kRadius_m);
}

TEST(Refine, KeepsTheUpperStrandOfACrossingStraight) {
  for (const double second_m : {0.57, 0.63}) {
    const DrawnRope rope = draw_rope(crossing_line(second_m));
    const Prior prior = refined(rope);
    const double upper_m = std::min(0.6, second_m);
    for (const std::size_t i : nodes_near(prior, 0, 0, 3 * kRadius_m)) {
      const double z = static_cast<double>(prior.nodes[i].z);
      if (z > 0.5 * (0.6 + second_m)) continue;
      EXPECT_NEAR(z, upper_m, 0.2 * kRadius_m) << "node " << i;
    }
  }
}

TEST(Refine, KeepsTheHiddenStrandOfACrossingOnItsOwnDepth) {
  for (const double second_m : {0.57, 0.63}) {
    const DrawnRope rope = draw_rope(crossing_line(second_m));
    const Prior prior = refined(rope);
    int below = 0;
    for (const std::size_t i : nodes_near(prior, 0, 0, 3 * kRadius_m)) {
      const double z = static_cast<double>(prior.nodes[i].z);
      if (z < 0.5 * (0.6 + second_m)) continue;
      EXPECT_NEAR(z, std::max(0.6, second_m), 0.3 * kRadius_m) << "node " << i;
      ++below;
    }
    EXPECT_GE(below, 1);
  }
}

double least_gap(const Prior& prior) {
  double upper = 1e9;
  double lower = 0;
  for (const std::size_t i : nodes_near(prior, 0, 0, 1.5 * kRadius_m)) {
    upper = std::min(upper, static_cast<double>(prior.nodes[i].z));
    lower = std::max(lower, static_cast<double>(prior.nodes[i].z));
  }
  return lower - upper;
}

// One strand arcs over the other: away from the crossing both lie at z = 0.6.
lab::Curve3 arching_line() {
  lab::Curve3 curve = crossing_line(0.6);
  for (Eigen::Vector3d& p : curve) {
    if (p.y() != 0) continue;
    const double t = std::min(1.0, std::abs(p.x()) / (9 * kRadius_m));
    p.z() -= 2.05 * kRadius_m * 0.5 * (1 + std::cos(std::numbers::pi * t));
  }
  return curve;
}

TEST(Refine, HoldsTheHiddenStrandADiameterBelowTheUpperOne) {
  EXPECT_GE(least_gap(refined(draw_rope(arching_line()))), 1.8 * kRadius_m);
}

TEST(Refine, HoldsStrandsADiameterApartWhereTheCrossingHasNoDepth) {
  DrawnRope rope = draw_rope(arching_line());
  for (int v = 215; v < 265; ++v) {
    for (int u = 295; u < 345; ++u) rope.image.depth_m[rope.index(u, v)] = 0;
  }
  EXPECT_GE(least_gap(refined(rope)), 1.5 * kRadius_m);
}

TEST(Refine, RunsInTheCanonicalDirectionWhateverThePathsDirection) {  // Sec. 3.3
  DrawnRope rope = draw_rope(crossing_line(0.63));
  const Prior forward = refined(rope);
  std::reverse(rope.path.points_px.begin(), rope.path.points_px.end());
  const Prior backward = refined(rope);
  EXPECT_TRUE(is_canonical(forward.nodes));
  EXPECT_TRUE(is_canonical(backward.nodes));
  for (std::size_t i = 0; i < forward.nodes.size(); ++i) {
    EXPECT_NEAR(forward.nodes[i].x, backward.nodes[i].x, 1e-3) << "node " << i;
    EXPECT_NEAR(forward.nodes[i].z, backward.nodes[i].z, 1e-3) << "node " << i;
  }
}

TEST(Refine, IsTheSameEveryTime) {
  const DrawnRope rope = draw_rope(crossing_line(0.63));
  const Prior first = refined(rope);
  const Prior second = refined(rope);
  EXPECT_EQ(first.nodes, second.nodes);
  EXPECT_EQ(first.support, second.support);
  EXPECT_EQ(first.sigma_m, second.sigma_m);
}

// Only pixels with u < 320 are visible points; node i lies at u = 120 + 400 i / 63.
TEST(Refine, SupportsTheNodesThatAVisiblePointBacks) {  // Eq. (3.6)
  DrawnRope rope = draw_rope(straight_line());
  erase_depth(rope, 320, 640);
  const Prior prior = refined(rope);
  for (std::size_t i = 0; i < prior.nodes.size(); ++i) {
    const float u = geometry::project(rope.image.camera, prior.nodes[i]).x();
    EXPECT_TRUE(u > 318 || prior.support[i] == 1) << "u = " << u;
    EXPECT_TRUE(u < 320 + 13 || prior.support[i] == 0) << "u = " << u;
  }
}

}  // namespace
}  // namespace flowdlo::prior
