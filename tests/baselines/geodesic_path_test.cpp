#include "baselines/traced_path.hpp"

#include <gtest/gtest.h>

#include "baselines/drawn.hpp"

namespace flowdlo::baselines {
namespace {

using test::drawn;

TEST(GeodesicPath, FollowsAPlainRopeEndToEnd) {
  const auto path = geodesic_path(drawn({{40, 60}, {160, 90}, {260, 200}}, 9));
  ASSERT_TRUE(path);
  EXPECT_NEAR(length_px(*path), 272, 25);
}

TEST(GeodesicPath, LosesTheLoopAtACrossing) {  // the thesis' own weakness, Table 4.4
  const auto path = geodesic_path(drawn(test::loop(), 9));
  ASSERT_TRUE(path);
  EXPECT_LT(length_px(*path), 350);  // of 530 px
}

TEST(GeodesicPath, TakesTheLongestPiece) {
  cv::Mat mask = drawn({{20, 30}, {60, 40}}, 9);
  drawn({{40, 100}, {260, 130}}, 9, mask);
  const auto path = geodesic_path(mask);
  ASSERT_TRUE(path);
  EXPECT_GT(path->front().y, 90);
}

TEST(GeodesicPath, EmptyMaskHasNone) { EXPECT_FALSE(geodesic_path(test::blank())); }

}  // namespace
}  // namespace flowdlo::baselines
