#include "synth/mask_segmenter.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "synth/still_life.hpp"

namespace flowdlo::synth {
namespace {

class MaskSegmenter : public testing::Test {
 protected:
  void SetUp() override { arrange(scene_, 0.5, DepthPrinciple::kStereo); }

  [[nodiscard]] std::vector<std::uint8_t> mask_with(const MaskFaults& faults) const {
    return segmented_mask(scene_.view, scene_.picture, faults, 1);
  }
  [[nodiscard]] static int width_at(const std::vector<std::uint8_t>& mask, int column) {
    int width = 0;
    for (int v = 0; v < 240; ++v) width += mask[static_cast<std::size_t>(v * 320 + column)] > 127;
    return width;
  }

  test::StillLife scene_;
};

TEST_F(MaskSegmenter, WithoutFaultsIsTheTrueMask) {
  EXPECT_EQ(mask_with({}), scene_.picture.mask);
  EXPECT_EQ(width_at(scene_.picture.mask, 160), 12);
}

TEST_F(MaskSegmenter, DilationAddsAPixelOnBothSides) {
  EXPECT_EQ(width_at(mask_with({.shift_px = 1}), 160), 14);
}

TEST_F(MaskSegmenter, ErosionTakesAPixelOnBothSides) {
  EXPECT_EQ(width_at(mask_with({.shift_px = -1}), 160), 10);
}

TEST_F(MaskSegmenter, AGapCutsTheRopeThrough) {
  const auto count = static_cast<double>(scene_.view.curves.front().points.size() - 1);
  const auto mask = mask_with({.gaps = {{0, 0.48 * count, 0.52 * count}}});
  EXPECT_EQ(width_at(mask, 160), 0);
  EXPECT_EQ(width_at(mask, 120), 12);
}

TEST_F(MaskSegmenter, SpecksAddMaskAwayFromTheRope) {
  const auto mask = mask_with({.specks = 8});
  EXPECT_GT(std::count(mask.begin(), mask.end(), 255),
            std::count(scene_.picture.mask.begin(), scene_.picture.mask.end(), 255));
}

TEST_F(MaskSegmenter, AFrayedBorderVariesAndStaysNear) {
  const auto mask = mask_with({.ragged_px = 2});
  int narrowest = 100;
  int widest = 0;
  for (int column = 80; column < 240; ++column) {
    narrowest = std::min(narrowest, width_at(mask, column));
    widest = std::max(widest, width_at(mask, column));
  }
  EXPECT_LT(narrowest, widest);
  EXPECT_GE(narrowest, 6);
  EXPECT_LE(widest, 20);
}

TEST_F(MaskSegmenter, AThinRopeIsFrayedOutwardsOnly) {
  const auto mask = mask_with({.ragged_px = 2, .frayed_inwards = false});
  for (std::size_t i = 0; i < mask.size(); ++i) ASSERT_GE(mask[i], scene_.picture.mask[i]);
}

}  // namespace
}  // namespace flowdlo::synth
