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
using testing::distance_to;
using testing::draw_rope;
using testing::DrawnRope;
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

/// Zero depth where x0 <= u < x1.
void erase_depth(DrawnRope& rope, int first_u, int last_u) {
  for (int v = 0; v < rope.image.height; ++v) {
    for (int u = first_u; u < last_u; ++u) rope.image.depth_m[rope.index(u, v)] = 0;
  }
}

TEST(Refine, PutsNodesOnTheAxisOfATubeSeenFaceOn) {
  const DrawnRope rope = draw_rope(straight_line());
  EXPECT_LT(farthest(refined(rope), rope.curve), 0.1 * kRadius_m);
}

TEST(Refine, PutsNodesOnTheAxisOfATubeThatRunsTowardsTheCamera) {  // at 45 degrees
  const DrawnRope rope = draw_rope({{-0.15, 0, 0.75}, {0.1, 0.02, 0.5}});
  EXPECT_LT(farthest(refined(rope), rope.curve), 0.15 * kRadius_m);
}

// Turns until it runs at 74 degrees to the image: the axis lies 3 radii and more behind the surface.
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

TEST(Refine, EndsWhereTheCenterlineOfARoundCapEnds) {
  const Prior prior = refined(draw_rope(straight_line()));
  EXPECT_NEAR(prior.nodes.front().x, -0.2, 0.2 * kRadius_m);
  EXPECT_NEAR(prior.nodes.back().x, 0.2, 0.2 * kRadius_m);
}

TEST(Refine, EndsAtTheTipsOfARopeCutOffSquare) {
  DrawnRope rope = draw_rope(straight_line());
  for (int v = 0; v < rope.image.height; ++v) {  // from u = 150 to 490
    for (int u = 0; u < rope.image.width; ++u) {
      if (u < 150 || u > 490) rope.image.mask[rope.index(u, v)] = 0;
    }
  }
  rope.path.points_px = {{150, 236.6F}, {490, 243.4F}};
  const Prior prior = refined(rope);
  EXPECT_NEAR(geometry::project(rope.image.camera, prior.nodes.front()).x(), 150, 1);
  EXPECT_NEAR(geometry::project(rope.image.camera, prior.nodes.back()).x(), 490, 1);
}

TEST(Refine, FollowsTheMaskBeyondAPathThatStopsShort) {  // by a width and a half at both ends
  DrawnRope rope = draw_rope(straight_line());
  auto& points = rope.path.points_px;  // 18 px
  points = {points.front() + 0.045F * (points.back() - points.front()),
            points.back() + 0.045F * (points.front() - points.back())};
  const Prior prior = refined(rope);
  EXPECT_NEAR(prior.nodes.front().x, -0.2, 0.3 * kRadius_m);
  EXPECT_NEAR(prior.nodes.back().x, 0.2, 0.3 * kRadius_m);
}

TEST(Refine, StopsAtTheImagesBorderWithoutTakingACapAway) {
  DrawnRope rope = draw_rope({{-0.4, 0, 0.6}, {0.1, 0, 0.6}});
  rope.path.points_px = {{0, 240}, {430, 240}};
  const Prior prior = refined(rope);
  EXPECT_NEAR(geometry::project(rope.image.camera, prior.nodes.front()).x(), 0, 1.5);
}

TEST(Refine, GoesToTheEdgeOfABarThatHidesTheRopesEnd) {  // at u = 450
  const lab::Bar bar{
      .point_px = {550, 240}, .direction = {0, 1}, .half_width_px = 100, .depth_m = 0.4};
  DrawnRope rope = draw_rope(straight_line(), {bar});
  std::erase_if(rope.path.points_px, [](const Eigen::Vector2f& p) { return p.x() > 449; });
  const Prior prior = refined(rope);
  EXPECT_NEAR(geometry::project(rope.image.camera, prior.nodes.back()).x(), 450, 1.5);
}

TEST(Refine, IsNotBentByNoiseAtTheTips) {
  DrawnRope rope = draw_rope(straight_line());
  std::mt19937 random(5);
  for (int v = 0; v < rope.image.height; ++v) {
    for (int u = 0; u < rope.image.width; ++u) {
      float& depth_m = rope.image.depth_m[rope.index(u, v)];
      if (u < 130 || u > 510)
        depth_m += 0.02F * (static_cast<float>(random() % 1000) / 1000 - 0.5F);
    }
  }
  const Prior prior = refined(rope);
  EXPECT_LT(farthest(prior, rope.curve), 0.5 * kRadius_m);
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

TEST(Refine, GivesASigmaThatGrowsFromWhatIsSeen) {
  DrawnRope rope = draw_rope(straight_line());
  erase_depth(rope, 320, 640);
  const Prior prior = refined(rope);
  EXPECT_LT(5 * prior.sigma_m[5], prior.sigma_m.back());
  for (std::size_t i = 40; i + 1 < prior.nodes.size(); ++i) {
    EXPECT_LT(prior.sigma_m[i], prior.sigma_m[i + 1]) << "node " << i;
  }
}

TEST(Refine, IsAsSureOfASquareTipAsOfARoundOne) {
  DrawnRope rope = draw_rope(straight_line());
  const float round_m = refined(rope).sigma_m.front();
  for (int v = 0; v < rope.image.height; ++v) {
    for (int u = 0; u < rope.image.width; ++u) {
      if (u >= 150 && u <= 490) continue;
      rope.image.mask[rope.index(u, v)] = 0;
      rope.image.depth_m[rope.index(u, v)] = 2;
    }
  }
  rope.path.points_px = {{150, 236.6F}, {490, 243.4F}};
  const Prior square = refined(rope);
  EXPECT_LT(round_m, 0.3 * kRadius_m);
  EXPECT_LT(square.sigma_m.front(), 0.6 * kRadius_m);
  EXPECT_LT(square.sigma_m.back(), 0.6 * kRadius_m);
}

TEST(Refine, DoubtsATipThatPointsAwayFromTheCamera) {  // both in plain sight
  const Prior across = refined(draw_rope(straight_line()));
  const Prior away = refined(draw_rope({{-0.12, 0.02, 0.75}, {0.06, 0.03, 0.45}}));
  EXPECT_GT(away.sigma_m.front(), 2 * across.sigma_m.front());
}

TEST(Refine, DoubtsTheTipsOfAFrayedMask) {
  DrawnRope rope = draw_rope(straight_line());
  const float clean_m = refined(rope).sigma_m.front();
  for (int u = 0; u < rope.image.width; ++u) {  // 10 px a wave, up to 3 px to both sides
    const int reach = static_cast<int>(std::lround(1.5 * (1 + std::sin(0.6 * u))));
    std::vector<std::uint8_t> column;
    for (int v = 0; v < rope.image.height; ++v) column.push_back(rope.image.mask[rope.index(u, v)]);
    for (int v = reach; v + reach < rope.image.height; ++v) {
      for (int off = -reach; off <= reach; ++off) {
        if (column[static_cast<std::size_t>(v + off)] > 127)
          rope.image.mask[rope.index(u, v)] = 255;
      }
    }
  }
  EXPECT_GT(refined(rope).sigma_m.front(), 1.5 * clean_m);
}

TEST(Refine, DoubtsTheNodesNearAnEndOutsideOfTheImage) {
  const Prior prior = refined(draw_rope({{-0.2, -0.004, 0.6}, {0.4, 0.008, 0.6}}));
  EXPECT_GT(prior.sigma_m.back(), 0.01F);
  EXPECT_LT(prior.sigma_m.front(), 0.003F);
  EXPECT_LT(prior.sigma_m[20], prior.sigma_m[50]);
}

/// Puts a gripper at that depth where the rope ends, from that column on.
void hold_end(DrawnRope& rope, int first, float depth_m) {
  for (int v = 220; v < 270; ++v) {
    for (int u = first; u < first + 40; ++u) {
      const std::size_t at = rope.index(u, v);
      rope.image.depth_m[at] = depth_m;
      rope.image.mask[at] = 0;
    }
  }
  for (Eigen::Vector2f& p : rope.path.points_px) {
    p.x() = std::min(p.x(), static_cast<float>(first - 1));
  }
  rope.path.points_px.erase(std::unique(rope.path.points_px.begin(), rope.path.points_px.end()),
                            rope.path.points_px.end());
  rope.path.bridged.resize(rope.path.points_px.size());
}

TEST(Refine, KeepsTheTipOfARopeThatAGripperHolds) {
  DrawnRope rope = draw_rope(straight_line());
  hold_end(rope, 520, 0.595F);
  const Prior prior = refined(rope);
  EXPECT_NEAR(prior.nodes.back().x, 0.2F, 0.0015F) << "a round cap lies within the gripper";
  EXPECT_NEAR(prior.nodes.front().x, -0.2F, 0.0015F);
  EXPECT_GT(prior.sigma_m.back(), 2 * prior.sigma_m.front());
}

TEST(Refine, KeepsAHeldTipBeforeABackgroundWithoutDepth) {
  DrawnRope rope = draw_rope(straight_line());
  for (std::size_t at = 0; at < rope.image.mask.size(); ++at) {
    if (rope.image.mask[at] == 0) rope.image.depth_m[at] = 0;
  }
  hold_end(rope, 520, 0.595F);
  const Prior prior = refined(rope);
  EXPECT_NEAR(prior.nodes.back().x, 0.2F, 0.0015F);
  EXPECT_GT(prior.sigma_m.back(), 2 * prior.sigma_m.front());
}

TEST(Refine, KeepsAHeldTipOfARopeThatRunsAwayFromTheCamera) {
  DrawnRope rope = draw_rope({{-0.2, 0, 0.5}, {0.2, 0, 0.7}});
  const int last = static_cast<int>(rope.path.points_px.back().x());
  hold_end(rope, last - 4, 0.7F);
  const Prior prior = refined(rope);
  EXPECT_GT(prior.sigma_m.back(), 2 * prior.sigma_m.front());
}

// Of ropes of slightly different lengths, so that some node lies in the middle of what is unseen.
TEST(Refine, TrustsAHiddenStrandLessThanAnEquallyLongHole) {
  float hidden_m = 0;
  float erased_m = 0;
  for (double more = 0; more < 0.02; more += 0.004) {
    lab::Curve3 curve = crossing_line(0.63);
    curve.emplace_back(0, 0.15 + more, 0.63);
    const Prior crossing = refined(draw_rope(curve));
    DrawnRope hole = draw_rope({{0, -0.2, 0.63}, {0, 0.15 + more, 0.63}});
    for (int v = 234; v < 247; ++v) {
      for (int u = 0; u < 640; ++u) hole.image.depth_m[hole.index(u, v)] = 0;
    }
    const Prior erased = refined(hole);
    hidden_m =
        std::max(hidden_m, *std::max_element(crossing.sigma_m.begin(), crossing.sigma_m.end()));
    erased_m = std::max(erased_m, *std::max_element(erased.sigma_m.begin(), erased.sigma_m.end()));
  }
  EXPECT_GT(hidden_m, 1.2F * erased_m);
}

}  // namespace
}  // namespace flowdlo::prior
