#include "reference/mask_features.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

namespace flowdlo {
namespace {

/// An 8 x 4 image with a 4 x 2 field; camera at its centre, focal length 4 px.
struct Scene {
  ops::FrameParams params{.fx = 4,
                          .fy = 4,
                          .cx = 3.5F,
                          .cy = 1.5F,
                          .width = 8,
                          .height = 4,
                          .field_width = 4,
                          .field_height = 2,
                          .point_count = 0,
                          .centroid_x = 0,
                          .centroid_y = 0,
                          .centroid_z = 0,
                          .reserved0 = 0,
                          .reserved1 = 0,
                          .reserved2 = 0,
                          .reserved3 = 0};
  std::vector<float> field = std::vector<float>(4 * 2 * 4, 0.0F);
  std::vector<float> depth;

  std::array<float, 8> at(float u, float v, float z) const {
    const std::vector<float> norm{0, 0, 0, 1};
    const std::vector<float> state{(u - params.cx) * z / params.fx, (v - params.cy) * z / params.fy,
                                   z, 0};
    std::array<float, 8> phi{};
    reference::mask_features(state, norm, params, field, depth, phi);
    return phi;
  }
  float& texel(int u, int v, int channel) {
    return field[static_cast<std::size_t>((v * 4 + u) * 4 + channel)];
  }
};

TEST(MaskFeatures, FieldIsReadBilinearlyAtHalfResolution) {
  Scene scene;
  scene.texel(1, 0, 0) = 1;
  // Pixel 2.5 lies on the centre of field column 1 ((2.5 + 0.5) / 2 - 0.5 = 1), row 0.5 on row 0.
  EXPECT_FLOAT_EQ(scene.at(2.5F, 0.5F, 1)[0], 1.0F);
  EXPECT_FLOAT_EQ(scene.at(3.5F, 0.5F, 1)[0], 0.5F);
  EXPECT_FLOAT_EQ(scene.at(3.5F, 1.5F, 1)[0], 0.25F);
}

TEST(MaskFeatures, DistancesArePixelsOfAnImage640WideOver100) {
  Scene scene;
  scene.texel(1, 0, 2) = 0.3F;  // 0.3 half-resolution px of 4 = 48 px of 640: 0.48
  scene.texel(1, 0, 3) = -0.4F;
  const auto phi = scene.at(2.5F, 0.5F, 1);
  EXPECT_FLOAT_EQ(phi[3], 0.48F);
  EXPECT_FLOAT_EQ(phi[4], -0.64F);
  EXPECT_FLOAT_EQ(phi[2], 0.8F);  // 0.5 * 1.6
}

TEST(MaskFeatures, DistancesAreClampedAtThree) {
  Scene scene;
  scene.texel(1, 0, 2) = -1000;
  const auto phi = scene.at(2.5F, 0.5F, 1);
  EXPECT_FLOAT_EQ(phi[2], 3.0F);
  EXPECT_FLOAT_EQ(phi[3], -3.0F);
}

TEST(MaskFeatures, AllAreZeroBehindTheCamera) {  // spec section 6
  Scene scene;
  for (float& value : scene.field) value = 1;
  EXPECT_EQ(scene.at(2, 1, -1), (std::array<float, 8>{}));
  EXPECT_EQ(scene.at(2, 1, 0.02F), (std::array<float, 8>{}));
}

TEST(MaskFeatures, OutsideTheFieldIsReadAtTheBorderAndMarked) {
  Scene scene;
  scene.texel(3, 1, 0) = 1;
  const auto phi = scene.at(100, 100, 1);
  EXPECT_FLOAT_EQ(phi[0], 1.0F);
  EXPECT_FLOAT_EQ(phi[5], 0.0F);
  EXPECT_FLOAT_EQ(scene.at(7, 3, 1)[5], 1.0F);
}

TEST(MaskFeatures, DepthResidualIsClippedAtTwentyCentimetres) {  // Eq. (3.16)
  Scene scene;
  scene.depth.assign(8 * 4, 0.30F);
  const auto near = scene.at(2, 1, 0.25F);  // (0.30 - 0.25) / 0.2
  EXPECT_NEAR(near[6], 0.25F, 1e-6);
  EXPECT_FLOAT_EQ(near[7], 1.0F);
  EXPECT_FLOAT_EQ(scene.at(2, 1, 2.0F)[6], -1.0F);
}

TEST(MaskFeatures, DepthOutsideItsRangeHasNoResidual) {  // below Eq. (3.16): 0.05 m to 0.5 m
  Scene scene;
  for (const float depth : {0.0F, 0.04F, 0.51F, std::numeric_limits<float>::quiet_NaN()}) {
    scene.depth.assign(8 * 4, depth);
    const auto phi = scene.at(2, 1, 0.4F);
    EXPECT_EQ(phi[6], 0.0F) << depth;
    EXPECT_EQ(phi[7], 0.0F) << depth;
  }
}

TEST(MaskFeatures, StateThatIsNotANumberReadsNothingOutside) {
  Scene scene;
  std::array<float, 8> phi{};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  reference::mask_features(std::vector<float>{nan, nan, 1, 0}, std::vector<float>{0, 0, 0, 1},
                           scene.params, scene.field, {}, phi);
  EXPECT_EQ(phi[5], 0.0F);
}

}  // namespace
}  // namespace flowdlo
