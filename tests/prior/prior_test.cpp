// Sec. 3.3. The straight path runs from pixel (0, 100) to (630, 100), so that node i lies at u = 10
// i.
#include "prior/prior.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "geometry/camera.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo::prior {
namespace {

constexpr Intrinsics kCamera{500, 500, 0, 100};

struct Sight {
  float u_px;
  float v_px;
  float depth_m;
};

path::Path path_through(std::vector<Eigen::Vector2f> points) {
  path::Path path;
  path.points_px = std::move(points);
  path.bridged.assign(path.points_px.size(), 0);
  return path;
}

path::Path straight_path() { return path_through({{0, 100}, {630, 100}}); }

evidence::VisiblePoints seen(const std::vector<Sight>& sights) {
  evidence::VisiblePoints visible;
  visible.count = static_cast<int>(sights.size());
  for (std::size_t i = 0; i < evidence::kVisiblePoints; ++i) {
    const Sight& sight = sights[i % sights.size()];
    visible.points_cam[i] = geometry::unproject(kCamera, sight.u_px, sight.v_px, sight.depth_m);
    visible.valid[i] = i < sights.size() ? 1 : 0;
  }
  return visible;
}

Frame frame_of_width(int width) { return {width, 480, kCamera, {}, {}, {}}; }

Prior lifted(const path::Path& path, const std::vector<Sight>& sights, int width = 640) {
  const Result<Prior> prior = lift(path, seen(sights), frame_of_width(width));
  EXPECT_TRUE(prior.has_value());
  return prior ? *prior : Prior{};
}

std::vector<int> supported_nodes(const Prior& prior) {
  std::vector<int> nodes;
  for (int i = 0; i < kNodes; ++i) {
    if (prior.support[static_cast<std::size_t>(i)] != 0) nodes.push_back(i);
  }
  return nodes;
}

// Nodes 29, 30, 31 lie 10, 0 and 10 px from u = 300; 28 and 32 lie 20.
TEST(Lift, SupportsTheNodesWithinTwelvePixels) {  // Eq. (3.3), (3.6)
  EXPECT_EQ(supported_nodes(lifted(straight_path(), {{300, 100, 1}})),
            (std::vector<int>{29, 30, 31}));
}

// 5 px beside the path: sqrt(10^2 + 5^2) = 11.2 <= 12; 7 px: sqrt(149) = 12.2 > 12.
TEST(Lift, MeasuresTheRadiusInTheImageAndNotAlongThePath) {  // Eq. (3.3)
  EXPECT_EQ(supported_nodes(lifted(straight_path(), {{300, 105, 1}})),
            (std::vector<int>{29, 30, 31}));
  EXPECT_EQ(supported_nodes(lifted(straight_path(), {{300, 107, 1}})), (std::vector<int>{30}));
}

// A hairpin of 606 px whose strands lie 6 px apart. Nodes 10 and 11 (s = 96.2, 105.8) are within
// 12 px of (100, 100); so are nodes 52 and 53 (s = 500.2, 509.8), on the way back.
TEST(Lift, DoesNotUseAPointForADistantPartOfThePath) {  // Eq. (3.3), arc window
  const auto hairpin = path_through({{0, 100}, {300, 100}, {300, 106}, {0, 106}});
  EXPECT_EQ(supported_nodes(lifted(hairpin, {{100, 100, 1}})), (std::vector<int>{10, 11}));
}

TEST(Lift, ScalesItsThresholdsWithTheWidthOfTheImage) {  // spec section 4
  EXPECT_EQ(supported_nodes(lifted(straight_path(), {{300, 100, 1}}, 1280)),
            (std::vector<int>{28, 29, 30, 31, 32}));
  EXPECT_EQ(supported_nodes(lifted(straight_path(), {{300, 100, 1}}, 320)), (std::vector<int>{30}));
}

// Points at u = 300, z = 1 and u = 306, z = 1.1. For node 30, at 300:
//   w_1 = 1, w_2 = exp(-(6/6)^2 / 2 - (6/12)^2 / 2) = exp(-0.625) = 0.535261
//   z = (1 + 0.535261 * 1.1) / 1.535261 = 1.034864
//   x = (0.6 + 0.535261 * 0.6732) / 1.535261 = 0.625521
// For node 31, at 310: w_1 = exp(-100/72 - 100/288) = 0.176204, w_2 = exp(-16/72 - 16/288) =
// 0.757465,
//   z = (0.176204 + 0.757465 * 1.1) / 0.933669 = 1.081128. Node 29 is 16 px from the second point.
TEST(Lift, AveragesWithTheWeightsWorkedByHand) {  // Eq. (3.4), (3.5)
  const Prior prior = lifted(straight_path(), {{300, 100, 1}, {306, 100, 1.1F}});
  EXPECT_EQ(supported_nodes(prior), (std::vector<int>{29, 30, 31}));
  EXPECT_NEAR(prior.nodes[30].z, 1.034864, 2e-6);
  EXPECT_NEAR(prior.nodes[30].x, 0.625521, 2e-6);
  EXPECT_NEAR(prior.nodes[31].z, 1.081128, 2e-6);
  EXPECT_FLOAT_EQ(prior.nodes[29].z, 1);
}

TEST(Lift, LeavesOutPointsThatOnlyPadTheSet) {  // Sec. 3.2, m_obs
  evidence::VisiblePoints visible = seen({{300, 100, 1}, {400, 100, 1}});
  visible.valid[1] = 0;
  const auto prior = lift(straight_path(), visible, frame_of_width(640));
  ASSERT_TRUE(prior.has_value());
  EXPECT_EQ(supported_nodes(*prior), (std::vector<int>{29, 30, 31}));
}

// Supported: 9, 10, 11 at z = 1 and 19, 20, 21 at z = 2. Node 13: alpha = (13 - 11) / (19 - 11).
TEST(Lift, InterpolatesBetweenSupportedNeighbours) {  // Eq. (3.7)
  const Prior prior = lifted(straight_path(), {{100, 100, 1}, {200, 100, 2}});
  EXPECT_FLOAT_EQ(prior.nodes[13].z, 1.25F);
  EXPECT_FLOAT_EQ(prior.nodes[15].z, 1.5F);
  EXPECT_FLOAT_EQ(prior.nodes[15].x, 0.5F * (0.2F + 0.8F));
  EXPECT_EQ(prior.support[15], 0);
}

TEST(Lift, CopiesTheOnlySupportedNeighbourToTheEnds) {  // below Eq. (3.7)
  const Prior prior = lifted(straight_path(), {{100, 100, 1}, {200, 100, 2}});
  EXPECT_EQ(prior.nodes[0], prior.nodes[9]);
  EXPECT_EQ(prior.nodes[63], prior.nodes[21]);
  EXPECT_EQ(prior.support[0], 0);
}

// One point at 1 m: no spread, so that the floor is left, 1 mm and one pixel (1 / 500 m). Node 40
// lies 90 px from node 31: 90 / 500 m, half of it as deviation.
TEST(Lift, GivesUnsupportedNodesASigmaThatGrowsWithTheGap) {
  const Prior prior = lifted(straight_path(), {{300, 100, 1}});
  EXPECT_NEAR(prior.sigma_m[30], 0.003, 1e-7);
  EXPECT_NEAR(prior.sigma_m[40], std::hypot(0.003, 0.09), 1e-6);
  EXPECT_LT(prior.sigma_m[40], prior.sigma_m[41]);
  EXPECT_LT(prior.sigma_m[20], prior.sigma_m[19]);
}

// Two points of equal weight for node 30, at z = 1 and 1.1 and (almost) the same pixel: each is
// 0.05 m from the mean along z, and 0.03 m along x.
TEST(Lift, GivesSupportedNodesTheSpreadOfTheirPoints) {
  const Prior prior = lifted(straight_path(), {{300, 100, 1}, {300, 100, 1.1F}});
  const double floor_m = 0.001 + 1.05 / 500;
  EXPECT_NEAR(prior.sigma_m[30], std::sqrt(0.05 * 0.05 + 0.03 * 0.03 + floor_m * floor_m), 1e-6);
}

TEST(Lift, TurnsTheResultToTheCanonicalDirection) {  // Sec. 3.3
  const std::vector<Sight> sights{{10, 100, 1}, {200, 100, 1.2F}, {500, 103, 0.8F}};
  const Prior forward = lifted(straight_path(), sights);
  const Prior backward = lifted(path_through({{630, 100}, {0, 100}}), sights);
  EXPECT_TRUE(is_canonical(backward.nodes));
  EXPECT_EQ(forward.support, backward.support);
  for (std::size_t i = 0; i < forward.nodes.size(); ++i) {
    EXPECT_NEAR(forward.nodes[i].x, backward.nodes[i].x, 1e-5) << "node " << i;
    EXPECT_NEAR(forward.nodes[i].z, backward.nodes[i].z, 1e-5) << "node " << i;
    EXPECT_NEAR(forward.sigma_m[i], backward.sigma_m[i], 1e-5) << "node " << i;
  }
}

TEST(IsCanonical, ComparesXThenYThenZOfTheEnds) {  // Sec. 3.3
  const auto canonical = [](Point3 first, Point3 last) {
    Centerline nodes{};
    nodes.front() = first;
    nodes.back() = last;
    return is_canonical(nodes);
  };
  EXPECT_TRUE(canonical({-1, 9, 9}, {1, 0, 0}));
  EXPECT_FALSE(canonical({1, 0, 0}, {-1, 9, 9}));
  EXPECT_TRUE(canonical({1, -2, 9}, {1, 2, 0}));
  EXPECT_FALSE(canonical({1, 2, 0}, {1, -2, 9}));
  EXPECT_TRUE(canonical({1, 2, 3}, {1, 2, 4}));
  EXPECT_FALSE(canonical({1, 2, 4}, {1, 2, 3}));
  EXPECT_TRUE(canonical({1, 2, 3}, {1, 2, 3}));
}

/// Passes (320, 240) at nodes 11 (s = 199), along u, and 53 (s = 959), along v.
path::Path crossing_path() {
  return path_through({{120, 240}, {520, 240}, {520, 60}, {320, 60}, {320, 420}});
}

TEST(Lift, PointUnderACrossingSupportsOnlyTheStrandItLiesOn) {  // Eq. (3.3), arc window
  const Prior prior = lifted(crossing_path(), {{320, 240, 0.4F}});
  EXPECT_NE(prior.support[11], prior.support[53]) << "exactly one strand may claim the point";
}

TEST(Lift, KeepsTheDepthOfBothStrandsOfACrossing) {  // spec section 4
  for (const float front_m : {0.40F, 0.46F}) {       // which strand is in front
    const float back_m = 0.43F;
    const bool u_in_front = front_m < back_m;
    std::vector<Sight> sights;
    for (float offset = -150; offset <= 150; offset += 5) {
      const bool hidden = std::abs(offset) < 8;
      if (!hidden || u_in_front) sights.push_back({320 + offset, 240, front_m});
      if (!hidden || !u_in_front) sights.push_back({320, 240 + offset, back_m});
    }
    const Prior prior = lifted(crossing_path(), sights);
    for (const std::size_t i : {10U, 11U, 12U}) EXPECT_NEAR(prior.nodes[i].z, front_m, 1e-5);
    for (const std::size_t i : {52U, 53U, 54U}) EXPECT_NEAR(prior.nodes[i].z, back_m, 1e-5);
  }
}

TEST(Lift, FailsWhenNoVisiblePointSupportsAnyNode) {
  const auto far = lift(straight_path(), seen({{300, 200, 1}}), frame_of_width(640));
  ASSERT_FALSE(far.has_value());
  EXPECT_EQ(far.error().code, ErrorCode::kNoEvidence);
  EXPECT_NE(far.error().message.find("12.0 px"), std::string::npos) << far.error().message;
  const auto none = lift(straight_path(), {}, frame_of_width(640));
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, ErrorCode::kNoEvidence);
}

TEST(Lift, FailsOnAPathThatIsNone) {
  const float nan = std::nanf("");
  for (const auto& points : {std::vector<Eigen::Vector2f>{}, {{1, 1}}, {{1, 1}, {nan, 1}}}) {
    const auto prior = lift(path_through(points), seen({{1, 1, 1}}), frame_of_width(640));
    ASSERT_FALSE(prior.has_value());
    EXPECT_EQ(prior.error().code, ErrorCode::kNoPath);
  }
}

TEST(Lift, IgnoresRepeatedPathPoints) {  // Eq. (3.1): they add no length
  const std::vector<Sight> sights{{100, 100, 1}, {300, 104, 1.1F}};
  const Prior once = lifted(straight_path(), sights);
  const Prior repeated = lifted(path_through({{0, 100}, {0, 100}, {630, 100}, {630, 100}}), sights);
  EXPECT_EQ(once.nodes, repeated.nodes);
  EXPECT_EQ(once.support, repeated.support);
}

TEST(Lift, WorksOnAPathWithoutLength) {
  const Prior prior = lifted(path_through({{300, 100}, {300, 100}}), {{300, 100, 1}});
  EXPECT_EQ(supported_nodes(prior).size(), 64U);
  EXPECT_EQ(prior.nodes[0], prior.nodes[63]);
}

TEST(Lift, StaysFiniteForPointsAtTheEndOfTheFloatRange) {
  const Prior prior = lifted(straight_path(), {{300, 100, 1e30F}, {300, 100, 1e-5F}});
  for (const Point3& node : prior.nodes) EXPECT_TRUE(std::isfinite(node.x + node.y + node.z));
  for (const float sigma_m : prior.sigma_m) EXPECT_TRUE(std::isfinite(sigma_m));
}

// The rope of the drawn frame has a strip without depth, 0.05 of the width long.
TEST(Lift, LiftsADrawnRopeToWithinMillimetres) {  // Eq. (3.1)-(3.7) together
  const flowdlo::testing::WaveFrame wave(640, 480);
  const Frame frame = wave.frame();
  path::Path path;
  for (int u = 64; u < 576; ++u) {
    const float phase = static_cast<float>(u) / 640 * 9;
    path.points_px.emplace_back(static_cast<float>(u), 240 + 96 * std::sin(phase));
  }
  const auto prior = lift(path, evidence::visible_points(evidence::unproject(frame)), frame);
  ASSERT_TRUE(prior.has_value());
  EXPECT_GE(supported_nodes(*prior).size(), 58U);
  EXPECT_LT(supported_nodes(*prior).size(), 64U);
  for (std::size_t i = 0; i < prior->nodes.size(); ++i) {
    const Eigen::Vector2f pixel = geometry::project(frame.intrinsics, prior->nodes[i]);
    EXPECT_NEAR(prior->nodes[i].z, 0.40F + 0.0001F * pixel.x(), 0.002) << "node " << i;
    const float centre = 240 + 96 * std::sin(pixel.x() / 640 * 9);
    EXPECT_NEAR(pixel.y(), centre, prior->support[i] != 0 ? 6 : 12) << "node " << i;
  }
}

TEST(Lift, IsTheSameEveryTime) {
  const flowdlo::testing::WaveFrame wave;
  const auto visible = evidence::visible_points(evidence::unproject(wave.frame()));
  const auto path = path_through({{32, 120}, {288, 120}});
  const auto first = lift(path, visible, wave.frame());
  const auto second = lift(path, visible, wave.frame());
  ASSERT_TRUE(first.has_value() && second.has_value());
  EXPECT_EQ(first->nodes, second->nodes);
  EXPECT_EQ(first->sigma_m, second->sigma_m);
}

}  // namespace
}  // namespace flowdlo::prior
