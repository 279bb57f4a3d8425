#include "reference/normalization.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace flowdlo {
namespace {

TEST(FrameNormalization, MeanAndScaleOfTheValidRows) {  // Eq. (3.8), (3.9)
  // (0,0,1) and (2,0,1): mean (1,0,1), root mean square distance 1; the third row is padding.
  std::vector<float> points(256 * 4, 0.0F);
  points[2] = points[3] = 1;
  points[4] = 2;
  points[6] = points[7] = 1;
  points[8] = 50;
  std::array<float, 4> norm{};
  reference::frame_normalization(points, norm);
  EXPECT_EQ(norm, (std::array<float, 4>{1, 0, 1, 1}));
}

TEST(FrameNormalization, NoValidRowGivesTheIdentity) {
  std::array<float, 4> norm{};
  reference::frame_normalization(std::vector<float>(256 * 4, 0.0F), norm);
  EXPECT_EQ(norm, (std::array<float, 4>{0, 0, 0, 1}));
}

TEST(FrameNormalization, PointsOnOneSpotGiveScaleOne) {
  std::vector<float> points;
  for (int i = 0; i < 256; ++i) points.insert(points.end(), {0.5F, 0.25F, 1.0F, 1.0F});
  std::array<float, 4> norm{};
  reference::frame_normalization(points, norm);
  EXPECT_EQ(norm, (std::array<float, 4>{0.5F, 0.25F, 1.0F, 1.0F}));
}

TEST(Normalize, DenormalizeIsItsInverseAndKeepsColumnThree) {  // Eq. (3.10)
  const std::array<float, 4> norm{1, 2, 3, 0.5F};
  const std::vector<float> points{1.5F, 2, 2, 7};
  std::vector<float> inside(4);
  std::vector<float> back(4);
  reference::normalize(points, norm, inside);
  EXPECT_EQ(inside, (std::vector<float>{1, 0, -2, 7}));
  reference::denormalize(inside, norm, back);
  EXPECT_EQ(back, points);
}

}  // namespace
}  // namespace flowdlo
