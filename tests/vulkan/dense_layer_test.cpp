#include "vulkan/dense_layer.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>

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

/// As the shader gemm takes a word apart.
std::array<float, 2> taken_apart(float word) {
  const auto pair = std::bit_cast<std::uint32_t>(word);
  const std::uint32_t first = (pair & 0x8FFFE000U) | 0x30000000U;
  const std::uint32_t second = ((pair << 13U) & 0x03FFE000U) | ((pair >> 2U) & 0x0C000000U) |
                               ((pair << 1U) & 0x80000000U) | 0x30000000U;
  return {std::bit_cast<float>(first), std::bit_cast<float>(second)};
}

TEST(PackPairs, HoldsTheSameInHalfTheSpace) {
  constexpr std::size_t kOut = 256;
  constexpr std::size_t kIn = 16;
  std::vector<float> weight(kOut * kIn);
  for (std::size_t i = 0; i < weight.size(); ++i) {
    const float significand = static_cast<float>(1024 + i * 7 % 1024) / 1024;
    weight[i] = std::ldexp(i % 3 == 0 ? -significand : significand, -static_cast<int>(i % 32));
  }
  ASSERT_TRUE(fit_pairs(weight));

  const std::vector<float> packed = pack_pairs(weight, kOut, kIn, 64);

  const std::vector<float> panels = pack_panels(weight, kOut, kIn, 64);
  ASSERT_EQ(packed.size(), panels.size() / 2);
  for (std::size_t texel = 0; texel < packed.size() / 4; ++texel) {
    for (std::size_t k = 0; k < 4; ++k) {
      const auto [first, second] = taken_apart(packed[texel * 4 + k]);
      ASSERT_EQ(first, panels[texel * 8 + k]) << "texel " << texel;
      ASSERT_EQ(second, panels[texel * 8 + 4 + k]) << "texel " << texel;
    }
  }
}

TEST(PackPairs, MakesOfZeroWhatNoSumNotices) {
  const std::vector<float> packed = pack_pairs(std::vector<float>(8 * 4, 0.0F), 8, 4, 8);

  for (const float word : packed) {
    EXPECT_EQ(taken_apart(word)[0], 0x1p-31F);
    EXPECT_EQ(taken_apart(word)[1], 0x1p-31F);
  }
}

TEST(FitPairs, TellsWhetherAnythingWouldBeLost) {
  EXPECT_TRUE(fit_pairs(std::vector<float>{0.25F, -1.9990234375F, 0.0F, -0.0F, 0x1p-31F}));
  EXPECT_FALSE(fit_pairs(std::vector<float>{0.25F, 0.1F})) << "more than 11 bits";
  EXPECT_FALSE(fit_pairs(std::vector<float>{2.0F})) << "too large";
  EXPECT_FALSE(fit_pairs(std::vector<float>{0x1p-32F})) << "too small";
  EXPECT_FALSE(fit_pairs(std::vector<float>{HUGE_VALF}));
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
