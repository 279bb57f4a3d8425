// Where refine lets the centerline begin and stop.
#include "prior/refined_prior.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "geometry/camera.hpp"
#include "prior/drawn_rope.hpp"

namespace flowdlo::prior {
namespace {

using testing::cut_off_square;
using testing::draw_rope;
using testing::DrawnRope;
using testing::farthest;
using testing::kRadius_m;
using testing::refined;
using testing::straight_line;

TEST(Refine, EndsWhereTheCenterlineOfARoundCapEnds) {
  const Prior prior = refined(draw_rope(straight_line()));
  EXPECT_NEAR(prior.nodes.front().x, -0.2, 0.2 * kRadius_m);
  EXPECT_NEAR(prior.nodes.back().x, 0.2, 0.2 * kRadius_m);
}

TEST(Refine, EndsAtTheTipsOfARopeCutOffSquare) {
  const DrawnRope rope = cut_off_square();
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

}  // namespace
}  // namespace flowdlo::prior
