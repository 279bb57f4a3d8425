#include "baselines/traced_path.hpp"

#include <gtest/gtest.h>

#include "baselines/drawn.hpp"

namespace flowdlo::baselines {
namespace {

using test::drawn;

TEST(DloftbsPath, BridgesAnOccludersGap) {
  cv::Mat mask = drawn({{30, 60}, {150, 75}}, 9);
  drawn({{190, 80}, {290, 92}}, 9, mask);
  const auto path = dloftbs_path(mask);
  ASSERT_TRUE(path);
  EXPECT_NEAR(length_px(*path), 252, 14);  // thinning shortens both ends by a radius or two
  EXPECT_LT(test::farthest_px(*path, {{30, 60},
                                      {60, 64},
                                      {90, 67},
                                      {120, 71},
                                      {150, 75},
                                      {170, 77},
                                      {190, 80},
                                      {220, 84},
                                      {250, 87},
                                      {290, 92}}),
            22);
}

TEST(DloftbsPath, GoesStraightOverACrossing) {
  const auto path = dloftbs_path(drawn(test::loop(), 9));
  ASSERT_TRUE(path);
  EXPECT_NEAR(length_px(*path), 560, 60);
}

TEST(DloftbsPath, SpecksAreNoSegments) {
  cv::Mat mask = drawn({{30, 60}, {250, 90}}, 9);
  cv::circle(mask, {100, 200}, 4, 255, cv::FILLED);
  const auto path = dloftbs_path(mask);
  ASSERT_TRUE(path);
  for (const auto& p : *path) EXPECT_LT(p.y, 110);
}

TEST(DloftbsPath, EmptyMaskHasNone) { EXPECT_FALSE(dloftbs_path(test::blank())); }

}  // namespace
}  // namespace flowdlo::baselines
