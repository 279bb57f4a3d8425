#include "geometry/camera.hpp"

#include <gtest/gtest.h>

namespace flowdlo::geometry {
namespace {

constexpr Intrinsics kCamera{500, 400, 320, 240};

// (420 - 320) * 2 / 500 = 0.4, (200 - 240) * 2 / 400 = -0.2
TEST(Camera, UnprojectsAPixelAsEquation2_2WorkedByHand) {
  EXPECT_EQ(unproject(kCamera, 420, 200, 2), (Point3{0.4F, -0.2F, 2}));
}

TEST(Camera, ThePrincipalPointLiesOnTheOpticalAxis) {
  EXPECT_EQ(unproject(kCamera, 320, 240, 0.7F), (Point3{0, 0, 0.7F}));
}

TEST(Camera, ProjectUndoesUnproject) {  // Eq. (2.2)
  const Eigen::Vector2f pixel = project(kCamera, unproject(kCamera, 13, 402, 0.35F));
  EXPECT_NEAR(pixel.x(), 13, 1e-4);
  EXPECT_NEAR(pixel.y(), 402, 1e-4);
}

TEST(Camera, PixelThresholdsScaleWithTheWidth) {  // spec section 4
  EXPECT_EQ(pixel_scale(640), 1.0F);
  EXPECT_EQ(pixel_scale(1280), 2.0F);
  EXPECT_EQ(pixel_scale(160), 0.25F);
}

}  // namespace
}  // namespace flowdlo::geometry
