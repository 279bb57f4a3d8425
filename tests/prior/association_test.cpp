// The s-hat of Eq. (3.3), and the choice of a strand near crossings, spec section 4.
#include "prior/association.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/polyline.hpp"

namespace flowdlo::prior {
namespace {

constexpr float kRadius_px = 12;
constexpr float kArcWindow_px = 36;
using Points = std::vector<Eigen::Vector2f>;

std::vector<float> associate_on(const Points& path, const std::vector<Sighting>& sightings) {
  return associate(path, geometry::cumulative_length(path), sightings, kRadius_px, kArcWindow_px);
}

float associate_one(const Points& path, const Sighting& sighting) {
  return associate_on(path, {sighting}).front();
}

/// Passes (320, 240) at arclength 200, along u, and at 960, along v. 1140 px long.
const Points kCrossing{{120, 240}, {520, 240}, {520, 60}, {320, 60}, {320, 420}};

/// Sightings on both strands of kCrossing, but none within `hidden_px` of the crossing.
std::vector<Sighting> both_strands(float along_u_m, float along_v_m, float hidden_px) {
  std::vector<Sighting> sightings;
  for (float offset = -150; offset <= 150; offset += 10) {
    if (std::abs(offset) < hidden_px) continue;
    sightings.push_back({{320 + offset, 240}, along_u_m});
    sightings.push_back({{320, 240 + offset}, along_v_m});
  }
  return sightings;
}

float associate_beside(std::vector<Sighting> others, const Sighting& sighting) {
  others.push_back(sighting);
  return associate_on(kCrossing, others).back();
}

TEST(Associate, FindsTheClosestPositionBetweenSamples) {  // Eq. (3.3)
  EXPECT_FLOAT_EQ(associate_one({{0, 0}, {100, 0}}, {{37.5F, 3}, 1}), 37.5F);
  EXPECT_FLOAT_EQ(associate_one({{0, 0}, {30, 40}, {130, 40}}, {{80, 45}, 1}), 100);
}

TEST(Associate, ClampsToTheEnds) {
  const Points path{{0, 0}, {100, 0}};
  EXPECT_EQ(associate_one(path, {{-5, 2}, 1}), 0);
  EXPECT_EQ(associate_one(path, {{105, 2}, 1}), 100);
}

TEST(Associate, LeavesOutWhatIsFartherThanTheRadius) {
  const Points path{{0, 0}, {100, 0}};
  EXPECT_GE(associate_one(path, {{50, 11.9F}, 1}), 0);
  EXPECT_LT(associate_one(path, {{50, 12.1F}, 1}), 0);
  EXPECT_LT(associate_one(path, {{-9, -9}, 1}), 0);
}

TEST(Associate, PassesOverRepeatedPoints) {
  const Points path{{0, 0}, {0, 0}, {50, 0}, {50, 0}, {50, 0}, {100, 0}, {100, 0}};
  EXPECT_FLOAT_EQ(associate_one(path, {{70, 1}, 1}), 70);
  EXPECT_FLOAT_EQ(associate_one(path, {{50, 1}, 1}), 50);
}

TEST(Associate, WorksOnAPathWithoutLength) {
  EXPECT_EQ(associate_one({{5, 5}, {5, 5}}, {{6, 6}, 1}), 0);
}

TEST(Associate, TakesNothingFromNoSightings) { EXPECT_TRUE(associate_on(kCrossing, {}).empty()); }

TEST(Associate, WithoutEvidenceTakesTheNearestStrand) {
  EXPECT_FLOAT_EQ(associate_one(kCrossing, {{322, 236}, 0.4F}), 956);  // 2 px from v's strand
  EXPECT_FLOAT_EQ(associate_one(kCrossing, {{324, 238}, 0.4F}), 204);  // 2 px from u's strand
}

TEST(Associate, BreaksATieOfStrandsToTheLowerArclength) {
  EXPECT_FLOAT_EQ(associate_one(kCrossing, {{320, 240}, 0.4F}), 200);
  EXPECT_FLOAT_EQ(associate_one(kCrossing, {{323, 243}, 0.4F}), 203);
}

TEST(Associate, GivesAPointUnderACrossingToTheStrandOfItsDepth) {
  const auto others = both_strands(0.40F, 0.43F, 20);
  EXPECT_FLOAT_EQ(associate_beside(others, {{320, 240}, 0.401F}), 200);
  EXPECT_FLOAT_EQ(associate_beside(others, {{320, 240}, 0.429F}), 960);
}

TEST(Associate, LetsDepthOutvoteNearness) {
  const auto others = both_strands(0.40F, 0.43F, 20);
  EXPECT_FLOAT_EQ(associate_beside(others, {{322, 234}, 0.40F}), 202);
  EXPECT_FLOAT_EQ(associate_beside(others, {{326, 238}, 0.43F}), 958);
}

TEST(Associate, LetsNearnessDecideWhereDepthsDifferByNoiseOnly) {
  const auto others = both_strands(0.4000F, 0.4005F, 20);
  EXPECT_FLOAT_EQ(associate_beside(others, {{322, 234}, 0.4000F}), 954);
  EXPECT_FLOAT_EQ(associate_beside(others, {{326, 238}, 0.4005F}), 206);
}

// The strand along u climbs by 1 mm a pixel, from 0.25 to 0.55 m, and is 0.40 m deep where it
// crosses the other one, 0.41 m deep throughout.
TEST(Associate, FollowsAStrandsSlopeToTheCrossing) {
  auto others = both_strands(0, 0.41F, 30);
  for (Sighting& sighting : others) {
    if (sighting.depth_m == 0) {
      sighting.depth_m = 0.40F + 0.001F * (sighting.position_px.x() - 320);
    }
  }
  EXPECT_FLOAT_EQ(associate_beside(others, {{320, 240}, 0.40F}), 200);
  EXPECT_FLOAT_EQ(associate_beside(others, {{320, 240}, 0.41F}), 960);
}

TEST(Associate, IsNotMisledByFlyingPixelsAmongTheEvidence) {
  auto others = both_strands(0.40F, 0.43F, 20);
  for (std::size_t i = 0; i < others.size(); i += 7) others[i].depth_m = 2;
  EXPECT_FLOAT_EQ(associate_beside(others, {{320, 240}, 0.40F}), 200);
  EXPECT_FLOAT_EQ(associate_beside(others, {{320, 240}, 0.43F}), 960);
}

TEST(Associate, GivesTheUnseenStrandWhatFitsTheSeenOneBadly) {
  std::vector<Sighting> others;
  for (float u = 200; u <= 440; u += 10) {
    if (std::abs(u - 320) > 20) others.push_back({{u, 240}, 0.40F});
  }
  EXPECT_FLOAT_EQ(associate_beside(others, {{320, 240}, 0.40F}), 200);
  EXPECT_FLOAT_EQ(associate_beside(others, {{320, 240}, 0.45F}), 960);
}

TEST(Associate, DoesNotDependOnTheOrderOfSightings) {
  auto sightings = both_strands(0.40F, 0.43F, 5);
  const auto forward = associate_on(kCrossing, sightings);
  std::reverse(sightings.begin(), sightings.end());
  auto backward = associate_on(kCrossing, sightings);
  std::reverse(backward.begin(), backward.end());
  EXPECT_EQ(forward, backward);
}

// A spiral of 10,000 samples, 6 px from turn to turn: several strands near every sighting.
TEST(Associate, FindsAStrandWithinTheRadiusOnAHugePath) {
  Points path;
  for (int i = 0; i < 10000; ++i) {
    const float angle = 0.02F * static_cast<float>(i);
    const float radius = 6 / 6.2832F * angle;
    path.emplace_back(320 + radius * std::cos(angle), 240 + radius * std::sin(angle));
  }
  const auto arclength = geometry::cumulative_length(path);
  for (std::size_t i = 50; i < path.size(); i += 487) {
    EXPECT_NEAR(associate_one(path, {path[i], 0.5F}), arclength[i], 0.1) << "sample " << i;
  }
}

}  // namespace
}  // namespace flowdlo::prior
