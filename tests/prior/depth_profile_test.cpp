#include "prior/depth_profile.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace flowdlo::prior {
namespace {

constexpr int kStations = 400;

/// `each` claims at every station of [first, last), on z = 0.5 m + slope i, with noise.
std::vector<DepthClaim> claims_on_line(int first, int last, float slope_m, float noise_m = 0) {
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0, 1);
  std::vector<DepthClaim> claims;
  for (int i = first; i < last; ++i) {
    for (int k = 0; k < 8; ++k) {
      claims.push_back({i, 0.5F + slope_m * static_cast<float>(i) + noise_m * noise(random), 1});
    }
  }
  return claims;
}

double line(int i, float slope_m) { return 0.5 + static_cast<double>(slope_m) * i; }

TEST(FitProfile, FollowsAStraightSlope) {
  const auto profile = fit_profile(kStations, claims_on_line(0, kStations, 2e-4F), {}, {});
  for (int i = 0; i < kStations; ++i) {
    EXPECT_NEAR(profile[static_cast<std::size_t>(i)], line(i, 2e-4F), 4e-4) << i;
  }
}

TEST(FitProfile, AveragesNoiseAway) {
  const auto profile = fit_profile(kStations, claims_on_line(0, kStations, 0, 0.004F), {}, {});
  for (const double z : profile) EXPECT_NEAR(z, 0.5, 0.0015);
}

TEST(FitProfile, IgnoresClaimsFarFromWhatMostSay) {
  auto claims = claims_on_line(0, kStations, 2e-4F);
  for (std::size_t k = 0; k < claims.size(); k += 3) claims[k].depth_m = 1.5F;
  const auto profile = fit_profile(kStations, claims, {}, {});
  for (int i = 0; i < kStations; ++i) {
    EXPECT_NEAR(profile[static_cast<std::size_t>(i)], line(i, 2e-4F), 1e-3) << i;
  }
}

TEST(FitProfile, BridgesGapsWithoutSwinging) {
  auto claims = claims_on_line(0, 100, 0, 0.002F);
  const auto other = claims_on_line(300, kStations, 0, 0.002F);
  claims.insert(claims.end(), other.begin(), other.end());
  const auto profile = fit_profile(kStations, claims, {}, {});
  for (const double z : profile) EXPECT_NEAR(z, 0.5, 0.004);
}

// The slope of 2e-4 m a station dies away over 48 stations: at most 0.0096 m are gained.
TEST(FitProfile, GoesOnBeyondTheLastClaimAlongADyingSlope) {
  const auto profile = fit_profile(kStations, claims_on_line(0, 200, 2e-4F), {}, {});
  EXPECT_NEAR(profile[210], line(210, 2e-4F), 1e-3);
  EXPECT_GT(profile[399], profile[210]);
  EXPECT_LT(profile[399], line(200, 2e-4F) + 0.011);
}

TEST(FitProfile, IsConstantThroughASingleClaim) {
  const std::vector<DepthClaim> claims{{200, 0.7F, 1}};
  for (const double z : fit_profile(kStations, claims, {}, {})) EXPECT_NEAR(z, 0.7, 1e-5);
}

TEST(FitProfile, BendsMoreWhereTheRopeRunsTowardsTheCamera) {  // a corner at station 200
  auto claims = claims_on_line(0, kStations, 0);
  for (DepthClaim& claim : claims) {
    claim.depth_m += 2e-3F * static_cast<float>(std::max(claim.station - 200, 0));
  }
  const std::vector<float> steep(kStations, 4.0F);
  const auto usual = fit_profile(kStations, claims, {}, {});
  const auto slanted = fit_profile(kStations, claims, {}, {.slant = steep});
  EXPECT_GT(usual[200], 0.503);
  EXPECT_LT(slanted[200] - 0.5, 0.75 * (usual[200] - 0.5));
}

TEST(FitProfile, ForgivesMoreWhereTheRopeRunsTowardsTheCamera) {  // every fourth is off
  auto claims = claims_on_line(0, kStations, 0, 0.001F);
  for (std::size_t k = 0; k < claims.size(); ++k) {
    const bool off = claims[k].station >= 300 && k % 4 == 0;
    if (off) claims[k].depth_m += 0.01F;
  }
  std::vector<float> slant(kStations, 1.0F);
  std::fill(slant.begin() + 300, slant.end(), 4.0F);
  EXPECT_LT(fit_profile(kStations, claims, {}, {})[360], 0.5005);
  EXPECT_GT(fit_profile(kStations, claims, {}, {.slant = slant})[360], 0.501);
}

TEST(FitProfile, WorksOnTwoStations) {
  const std::vector<DepthClaim> claims{{0, 0.7F, 1}, {1, 0.7F, 1}};
  for (const double z : fit_profile(2, claims, {}, {})) EXPECT_NEAR(z, 0.7, 1e-6);
}

}  // namespace
}  // namespace flowdlo::prior
