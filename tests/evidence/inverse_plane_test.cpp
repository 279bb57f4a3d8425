#include "evidence/inverse_plane.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace flowdlo::evidence {
namespace {

using Eigen::Vector3d;

const Vector3d kNormal(0.3, -0.5, 1.8);
constexpr double kNoise = 0.002;  // 1 / m

/// `others` of 500 depths are of something nearer.
std::vector<InverseDepth> depths(int others) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> aside(-0.5, 0.5);
  std::normal_distribution<double> noise(0, kNoise);
  std::vector<InverseDepth> result;
  for (int i = 0; i < 500; ++i) {
    const Vector3d ray(aside(random), aside(random), 1);
    const double nearer = i < others ? 0.4 + 0.2 * aside(random) : 0;
    result.push_back({ray, kNormal.dot(ray) + nearer + noise(random)});
  }
  return result;
}

TEST(InversePlane, GoesThroughNoisyDepths) {
  const auto plane = inverse_plane(depths(0));
  ASSERT_TRUE(plane);
  EXPECT_LT((plane->normal - kNormal).norm(), 0.001);
  EXPECT_NEAR(plane->misfit, kNoise, 0.2 * kNoise);
}

TEST(InversePlane, HoldsTwoFifthsOfSomethingElse) {
  const auto plane = inverse_plane(depths(200));
  ASSERT_TRUE(plane);
  EXPECT_LT((plane->normal - kNormal).norm(), 0.002);
  EXPECT_LT(plane->off({{0, 0, 1}, 2.2}), 0) << "what is nearer than the plane";
}

TEST(InversePlane, OfTheSameDepthsIsTheSame) {
  EXPECT_EQ(inverse_plane(depths(100))->normal, inverse_plane(depths(100))->normal);
}

TEST(InversePlane, NeedsDepthsThatSpanOne) {
  std::vector<InverseDepth> few = depths(0);
  few.resize(47);
  EXPECT_FALSE(inverse_plane(few));
  EXPECT_FALSE(inverse_plane({}));
  std::vector<InverseDepth> line;
  for (int i = 0; i < 200; ++i) line.push_back({{0.002 * i, 0.001 * i, 1}, 2 + 0.01 * i});
  EXPECT_FALSE(inverse_plane(line));
}

}  // namespace
}  // namespace flowdlo::evidence
