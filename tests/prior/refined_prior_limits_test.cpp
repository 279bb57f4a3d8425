// What refine makes of little, broken or no evidence.
#include "prior/refined_prior.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

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

TEST(Refine, WorksOnAPathOfTwoPoints) {
  DrawnRope rope = draw_rope(straight_line());
  rope.path.points_px = {rope.path.points_px.front(), rope.path.points_px.back()};
  EXPECT_LT(farthest(refined(rope), rope.curve), 0.1 * kRadius_m);
}

TEST(Refine, WorksWithAHandfulOfDepths) {
  DrawnRope rope = draw_rope(straight_line());
  const auto full = rope.image.depth_m;
  std::fill(rope.image.depth_m.begin(), rope.image.depth_m.end(), 0.0F);
  for (const int u : {180, 300, 460}) {
    rope.image.depth_m[rope.index(u, 240)] = full[rope.index(u, 240)];
  }
  EXPECT_LT(farthest(refined(rope), rope.curve), 0.3 * kRadius_m);
}

TEST(Refine, StaysFiniteWhateverTheWidthItIsTold) {
  DrawnRope rope = draw_rope(crossing_line(0.63));
  for (const float width_px : {0.0F, 0.3F, -5.0F, std::nanf(""), 3000.0F}) {
    rope.width_px = width_px;
    const Result<Prior> prior = rope.refined();
    ASSERT_TRUE(prior.has_value());
    EXPECT_TRUE(geometry::all_finite(prior->nodes)) << width_px;
    for (const float sigma_m : prior->sigma_m) EXPECT_TRUE(std::isfinite(sigma_m)) << width_px;
  }
}

TEST(Refine, StaysFiniteOnWildDepths) {
  DrawnRope rope = draw_rope(crossing_line(0.63));
  std::mt19937 random(11);
  for (float& depth_m : rope.image.depth_m) {
    const float wild[] = {0, 1e-5F, 0.6F, 1e4F, std::nanf(""), INFINITY, -1, 1e30F};
    depth_m = wild[random() % 8];
  }
  const Result<Prior> prior = rope.refined();
  ASSERT_TRUE(prior.has_value());
  EXPECT_TRUE(geometry::all_finite(prior->nodes));
}

TEST(Refine, StaysFiniteOnAPathThatLeavesTheImage) {
  DrawnRope rope = draw_rope(straight_line());
  rope.path.points_px.insert(rope.path.points_px.begin() + 200, {1e9F, -1e9F});
  const Result<Prior> prior = rope.refined();
  ASSERT_TRUE(prior.has_value());
  EXPECT_TRUE(geometry::all_finite(prior->nodes));
}

TEST(Refine, WorksOnAPathWithoutLength) {
  DrawnRope rope = draw_rope(straight_line());
  for (const float far : {0.0F, 1e-4F, 0.5F}) {
    rope.path.points_px = {{300, 240}, {300 + far, 240}};
    const Result<Prior> prior = rope.refined();
    ASSERT_TRUE(prior.has_value());
    EXPECT_TRUE(geometry::all_finite(prior->nodes));
  }
}

TEST(Refine, WorksOnAClosedRing) {
  lab::Curve3 ring;
  for (double a = 0; a <= 1; a += 0.005) {
    ring.emplace_back(0.1 * std::cos(6.2832 * a), 0.1 * std::sin(6.2832 * a), 0.6);
  }
  const DrawnRope rope = draw_rope(ring);
  EXPECT_LT(farthest(refined(rope), rope.curve), 0.15 * kRadius_m);
}

TEST(Refine, FailsWithoutADepthOnTheMask) {
  DrawnRope rope = draw_rope(straight_line());
  std::fill(rope.image.depth_m.begin(), rope.image.depth_m.end(), 0.0F);
  const Result<Prior> prior = rope.refined();
  ASSERT_FALSE(prior.has_value());
  EXPECT_EQ(prior.error().code, ErrorCode::kNoEvidence);
}

TEST(Refine, FailsWhenThePathRunsBesideTheMask) {
  DrawnRope rope = draw_rope(straight_line());
  rope.path.points_px = {{100, 60}, {500, 60}};
  const Result<Prior> prior = rope.refined();
  ASSERT_FALSE(prior.has_value());
  EXPECT_EQ(prior.error().code, ErrorCode::kNoEvidence);
}

TEST(Refine, FailsWhenNoVisiblePointSupportsANode) {
  const DrawnRope rope = draw_rope(straight_line());
  const auto prior =
      refine(rope.path, rope.width_px, evidence::unproject(rope.frame()), {}, rope.frame());
  ASSERT_FALSE(prior.has_value());
  EXPECT_EQ(prior.error().code, ErrorCode::kNoEvidence);
}

TEST(Refine, FailsOnAPathThatIsNone) {
  DrawnRope rope = draw_rope(straight_line());
  const float nan = std::nanf("");
  for (const auto& points : {std::vector<Eigen::Vector2f>{}, {{1, 1}}, {{1, 1}, {nan, 1}}}) {
    rope.path.points_px = points;
    const Result<Prior> prior = rope.refined();
    ASSERT_FALSE(prior.has_value());
    EXPECT_EQ(prior.error().code, ErrorCode::kNoPath);
  }
}

TEST(Refine, FailsWhenTheImagesDoNotFitTheFrame) {
  const DrawnRope rope = draw_rope(straight_line());
  Frame frame = rope.frame();
  const auto cloud = evidence::unproject(frame);
  frame.depth_m = {};
  const auto prior =
      refine(rope.path, rope.width_px, cloud, evidence::visible_points(cloud), frame);
  ASSERT_FALSE(prior.has_value());
  EXPECT_EQ(prior.error().code, ErrorCode::kBadInput);
}

}  // namespace
}  // namespace flowdlo::prior
