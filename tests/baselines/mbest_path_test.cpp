#include "baselines/traced_path.hpp"

#include <gtest/gtest.h>

#include "baselines/drawn.hpp"

namespace flowdlo::baselines {
namespace {

using test::drawn;

TEST(MbestPath, GoesRoundTheLoopAndStraightOverTheCrossing) {
  const auto path = mbest_path(drawn(test::loop(), 9));
  ASSERT_TRUE(path) << path.error().message;
  EXPECT_NEAR(length_px(*path), 560, 40);
  EXPECT_LT(test::farthest_px(*path, test::loop()), 8);
}

TEST(MbestPath, SpursOfARaggedMaskAreNotPartOfIt) {
  cv::Mat mask = drawn({{40, 120}, {280, 135}}, 11);
  drawn({{150, 120}, {150, 112}}, 3, mask);
  const auto path = mbest_path(mask);
  ASSERT_TRUE(path);
  EXPECT_NEAR(length_px(*path), 238, 14);
}

TEST(MbestPath, FlatCrossingReadAsTwoForksIsOneX) {
  cv::Mat mask = drawn({{30, 90}, {290, 150}}, 9);
  drawn({{30, 150}, {290, 90}}, 9, mask);
  const auto path = mbest_path(mask);
  ASSERT_TRUE(path);
  EXPECT_GT(std::abs(path->front().y - path->back().y), 40);  // and not back on its own side
}

TEST(MbestPath, ClosedLoopsHaveNone) {
  cv::Mat mask = test::blank();
  cv::circle(mask, {160, 120}, 60, 255, 9);
  EXPECT_FALSE(mbest_path(mask));
}

TEST(MbestPath, GapsAreNotBridged) {
  cv::Mat mask = drawn({{30, 60}, {150, 70}}, 9);
  drawn({{190, 74}, {270, 82}}, 9, mask);
  const auto path = mbest_path(mask);
  ASSERT_TRUE(path);
  EXPECT_LT(length_px(*path), 130);
}

TEST(MbestPath, EmptyMaskHasNone) { EXPECT_FALSE(mbest_path(test::blank())); }

}  // namespace
}  // namespace flowdlo::baselines
