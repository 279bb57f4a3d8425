#include "synth/depth_sensor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "synth/still_life.hpp"

namespace flowdlo::synth {
namespace {

using test::StillLife;

// Of the table, in a corner of the image where nothing else is.
double deviation(const StillLife& scene, const std::vector<float>& depth_m) {
  double sum = 0;
  int count = 0;
  for (int v = 5; v < 60; ++v) {
    for (int u = 5; u < 300; ++u) {
      const auto p = static_cast<std::size_t>(v * scene.sensor.width + u);
      sum += std::pow(depth_m[p] - scene.picture.depth_m[p], 2);
      ++count;
    }
  }
  return std::sqrt(sum / count);
}

double noise_at(double distance_m, DepthPrinciple principle) {
  StillLife scene;
  arrange(scene, distance_m, principle);
  const auto depth_m = measured_depth(scene.view, scene.picture, scene.ropes(), {.noise = true}, 1);
  return deviation(scene, depth_m);
}

TEST(DepthSensor, TheIdealPictureIsTableAndRope) {
  StillLife scene;
  arrange(scene, 0.5, DepthPrinciple::kStereo);
  const std::size_t middle = 119 * 320 + 160;
  EXPECT_EQ(scene.picture.mask[middle], 255);
  EXPECT_NEAR(scene.picture.depth_m[middle], 0.5 - scene.rope.radius_m, 2e-4);
  EXPECT_EQ(scene.picture.mask[40 * 320 + 160], 0);
  EXPECT_NEAR(scene.picture.depth_m[40 * 320 + 160], 0.5 + scene.rope.radius_m, 1e-5);
}

TEST(DepthSensor, WithoutFaultsOnlyRoundsToItsUnit) {
  StillLife scene;
  arrange(scene, 0.7, DepthPrinciple::kStereo);
  const auto depth_m = measured_depth(scene.view, scene.picture, scene.ropes(), {}, 1);
  for (std::size_t i = 0; i < depth_m.size(); ++i) {
    ASSERT_NEAR(depth_m[i], scene.picture.depth_m[i], 0.51 * kDepthScale_m);
  }
}

TEST(DepthSensor, StereoNoiseGrowsWithTheSquareOfTheDistance) {
  const double ratio =
      noise_at(1.4, DepthPrinciple::kStereo) / noise_at(0.7, DepthPrinciple::kStereo);
  EXPECT_NEAR(ratio, 4, 0.6);
}

TEST(DepthSensor, StereoNoiseIsThatOfTheDisparity) {  // dz = z^2 / (f b) dd
  const double expected = 0.7 * 0.7 / (300 * 0.05) * 0.08;
  EXPECT_NEAR(noise_at(0.7, DepthPrinciple::kStereo), expected, 0.25 * expected);
}

TEST(DepthSensor, StereoDepthComesInStepsOfDisparity) {
  StillLife scene;
  arrange(scene, 1.2, DepthPrinciple::kStereo);
  const auto depth_m = measured_depth(scene.view, scene.picture, scene.ropes(), {.noise = true}, 1);
  std::set<float> values(depth_m.begin(), depth_m.begin() + 60 * 320);
  EXPECT_LT(values.size(), 60U);  // a step of 1/32 px is 3 mm here
}

TEST(DepthSensor, TimeOfFlightNoiseIsAboutItsFigureAtAMetre) {
  EXPECT_NEAR(noise_at(1.0, DepthPrinciple::kTimeOfFlight), 0.0015, 0.0003);
}

TEST(DepthSensor, WholeMillimetresAreWhole) {
  StillLife scene;
  arrange(scene, 0.5, DepthPrinciple::kTimeOfFlight);
  const auto depth_m = measured_depth(scene.view, scene.picture, scene.ropes(),
                                      {.noise = true, .whole_mm = true}, 1);
  for (const float z : depth_m) ASSERT_NEAR(std::round(z * 1000) / 1000, z, 1e-6);
}

TEST(DepthSensor, ALostStretchHasNoDepthAndTheRestHas) {
  StillLife scene;
  arrange(scene, 0.5, DepthPrinciple::kStereo);
  DepthFaults faults;
  faults.lost.push_back({0, 10, 20});
  const auto depth_m = measured_depth(scene.view, scene.picture, scene.ropes(), faults, 1);
  for (const Surface& seen : scene.picture.surfaces) {
    EXPECT_EQ(depth_m[seen.pixel] > 0, seen.along < 10 || seen.along > 20);
  }
}

TEST(DepthSensor, FlyingPixelsLieBetweenRopeAndTable) {
  StillLife scene;
  arrange(scene, 0.5, DepthPrinciple::kTimeOfFlight);
  const auto depth_m = measured_depth(scene.view, scene.picture, scene.ropes(), {.flying = 1.0}, 1);
  int flying = 0;
  for (std::size_t i = 0; i < depth_m.size(); ++i) {
    EXPECT_GE(depth_m[i], 0.5 - scene.rope.radius_m - 1e-3);
    EXPECT_LE(depth_m[i], 0.5 + scene.rope.radius_m + 1e-3);
    flying += std::abs(depth_m[i] - scene.picture.depth_m[i]) > 0.002 ? 1 : 0;
  }
  EXPECT_GT(flying, 100);
}

TEST(DepthSensor, DropoutTakesTheBorderOnly) {
  StillLife scene;
  arrange(scene, 0.5, DepthPrinciple::kTimeOfFlight);
  const auto depth_m =
      measured_depth(scene.view, scene.picture, scene.ropes(), {.dropout = 1.0}, 1);
  EXPECT_GT(depth_m[119 * 320 + 160], 0);
  int lost = 0;
  for (int v = 100; v < 140; ++v)
    lost += depth_m[static_cast<std::size_t>(v * 320 + 160)] > 0 ? 0 : 1;
  EXPECT_EQ(lost, 4);  // a pixel inside and one outside, on both sides
}

}  // namespace
}  // namespace flowdlo::synth
