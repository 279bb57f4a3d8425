#include "vulkan/dense_layer.hpp"

#include <gtest/gtest.h>

#include <bit>

namespace flowdlo::vulkan {
namespace {

TEST(PackPanels, PutsFourConsecutiveInputsOfAColumnIntoATexelAndColumnsSideBySide) {
  constexpr int kOut = 512;
  constexpr int kIn = 16;
  std::vector<float> weight(kOut * kIn);
  for (std::size_t i = 0; i < weight.size(); ++i) weight[i] = static_cast<float>(i);

  const std::vector<float> packed = pack_panels(weight, kOut, kIn, 256);

  const auto at = [&](std::size_t panel, std::size_t k4, std::size_t column, std::size_t k) {
    return packed[((panel * 4 + k4) * 256 + column) * 4 + k];
  };
  EXPECT_EQ(at(0, 0, 0, 0), weight[0]);
  EXPECT_EQ(at(0, 0, 0, 3), weight[3]);
  EXPECT_EQ(at(0, 0, 1, 0), weight[16]);
  EXPECT_EQ(at(0, 2, 5, 1), weight[5 * 16 + 9]);
  EXPECT_EQ(at(1, 3, 7, 2), weight[(256 + 7) * 16 + 14]);
}

TEST(PackHalfPanels, HoldsTheSameInHalfTheSpace) {
  constexpr int kOut = 256;
  constexpr int kIn = 16;
  std::vector<float> weight(kOut * kIn);
  for (std::size_t i = 0; i < weight.size(); ++i) weight[i] = static_cast<float>(i % 2048) / 8;

  EXPECT_EQ(pack_half_panels(weight, kOut, kIn, 64),
            pack_halves(pack_panels(weight, kOut, kIn, 64)));
}

TEST(PackHalves, PutsTwoValuesIntoThePlaceOfOne) {
  const std::vector<float> weight{1.0F, -2.0F, 0.5F, 65504.0F};

  const std::vector<float> packed = pack_halves(weight);

  ASSERT_EQ(packed.size(), 2U);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(packed[0]), 0xC0003C00U);  // the first is the lower
  EXPECT_EQ(std::bit_cast<std::uint32_t>(packed[1]), 0x7BFF3800U);
}

TEST(AreHalves, TellsWhetherAnythingWouldBeLost) {
  EXPECT_TRUE(are_halves(std::vector<float>{0.25F, -1025.0F, 0.0F}));
  EXPECT_FALSE(are_halves(std::vector<float>{0.25F, 0.1F}));
  EXPECT_FALSE(are_halves(std::vector<float>{1e6F})) << "beyond f16";
}

}  // namespace
}  // namespace flowdlo::vulkan
