#include "geometry/segments.hpp"

#include <gtest/gtest.h>

namespace flowdlo::geometry {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;

TEST(Segments, ThatCrossMeetAtTheirShares) {
  const auto found = meeting<double>({0, 0}, {4, 0}, {1, -1}, {0, 4});
  ASSERT_TRUE(found);
  EXPECT_DOUBLE_EQ((*found)[0], 0.25);
  EXPECT_DOUBLE_EQ((*found)[1], 0.25);
}

TEST(Segments, ThatEndBeforeTheOtherOneDoNotMeet) {
  EXPECT_FALSE(meeting<float>({0, 0}, {4, 0}, {5, -1}, {0, 4}));
  EXPECT_FALSE(meeting<float>({0, 0}, {4, 0}, {1, 1}, {0, 4}));
}

TEST(Segments, BeginInThemselvesAndDoNotEndThere) {
  EXPECT_TRUE(meeting<float>({0, 0}, {4, 0}, {0, 0}, {0, 4}));
  EXPECT_FALSE(meeting<float>({0, 0}, {4, 0}, {4, -1}, {0, 4}));
}

TEST(Segments, ThatAreParallelDoNotMeet) {
  EXPECT_FALSE(meeting<float>({0, 0}, {4, 0}, {1, 0}, {4, 0}));
  EXPECT_FALSE(meeting<float>({0, 0}, {4, 0}, {1, 1}, {-4, 0}));
}

TEST(Segments, TurnFromXToYIsPositive) {
  EXPECT_GT(cross<float>(Vector2f(1, 0), Vector2f(0, 1)), 0);
  EXPECT_LT(cross<double>(Vector2d(0, 1), Vector2d(1, 0)), 0);
}

}  // namespace
}  // namespace flowdlo::geometry
