#include "field/near_parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "field/axes.hpp"
#include "reference/program.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo::field {
namespace {

constexpr int kWidth_px = 256;
constexpr int kHeight_px = 64;
constexpr int kMiddle = 32;
constexpr float kOctaves = 1.25F;  // of the near half

// A rope along the middle row, that is as wide as expected on the left, and wider from column
// `from` on.
Channels rope(int from) {
  Channels field({kWidth_px, kHeight_px}, {});
  for (int v = 0; v < kHeight_px; ++v) {
    for (int u = 0; u < kWidth_px; ++u) {
      const float octaves = u < from ? 0.0F : kOctaves;
      if (std::abs(static_cast<float>(v - kMiddle)) > 0.5F * kRope_px * std::exp2(octaves))
        continue;
      field.at(v, u)[kRope] = 1;
      field.at(v, u)[kWidth] = octaves;
    }
  }
  return field;
}

// Of the whole field, so that pixels of the frame are those of the region at `scale` 1.
Region region_at(float scale) {
  Region region;
  region.box = {0, 0, kWidth_px, kHeight_px};
  region.size = {static_cast<int>(kWidth_px * scale), static_cast<int>(kHeight_px * scale)};
  region.scale = {scale, scale};
  return region;
}

TEST(NearParts, ARopeAsWideAsExpectedNeedsNoOtherLook) {
  EXPECT_EQ(wide_octaves(rope(kWidth_px)), 0);
  EXPECT_EQ(wide_octaves(Channels({kWidth_px, kHeight_px}, {})), 0);
}

TEST(NearParts, AFewWidePixelsNeedNone) { EXPECT_EQ(wide_octaves(rope(kWidth_px - 3)), 0); }

TEST(NearParts, WherePartOfItIsWideItsWidthIsTold) {
  EXPECT_FLOAT_EQ(wide_octaves(rope(kWidth_px / 2)), kOctaves);
}

TEST(NearParts, TheOtherLookCountsWhereTheRopeIsWideAlone) {
  const NearParts parts(rope(kWidth_px / 2), kOctaves);
  EXPECT_EQ(parts.share(kWidth_px / 4, kMiddle), 0);
  EXPECT_EQ(parts.share(3 * kWidth_px / 4, kMiddle), 1);
  for (int u = kWidth_px / 4; u < 3 * kWidth_px / 4; ++u) {
    EXPECT_LE(parts.share(u, kMiddle), parts.share(u + 1, kMiddle)) << u;
    EXPECT_LT(parts.share(u + 1, kMiddle) - parts.share(u, kMiddle), 0.2F) << u;
  }
}

TEST(NearParts, OnlyItsBlocksAreLookedAt) {
  const Channels field = rope(kWidth_px / 2);
  const NearParts parts(field, kOctaves);
  const BlockMap all = blocks_near(image::Image<float>({kWidth_px, kHeight_px}, 1.0F));
  const BlockMap needed = parts.needed(all, region_at(1), region_at(1));
  ASSERT_FALSE(needed.blocks.empty());
  EXPECT_LT(needed.blocks.size(), all.blocks.size());
  const int first = std::min_element(needed.blocks.begin(), needed.blocks.end(),
                                     [](const auto& a, const auto& b) { return a.x < b.x; })
                        ->x;
  EXPECT_GE((first + 2) * kBlock_px, kWidth_px / 2);  // one around what is needed, and no more
}

TEST(NearParts, BlendTakesTheOtherLooksWordsAndWidthsInThisOnesUnits) {
  StrandField field{region_at(1), rope(kWidth_px / 2)};
  const NearParts parts(field.channels, kOctaves);
  StrandField other{region_at(0.5F), Channels({kWidth_px / 2, kHeight_px / 2}, {})};
  std::array<float, kChannels> says{};
  says[kCentre] = 0.75F;
  says[kRope] = 1;
  says[kWidth] = 0.25F;
  other.channels.fill(says);
  blend(field, other, parts, kOctaves);
  const auto& far = field.channels.at(kMiddle, kWidth_px / 4);
  EXPECT_EQ(far[kCentre], 0);
  EXPECT_EQ(far[kWidth], 0);
  const auto& near = field.channels.at(kMiddle, 3 * kWidth_px / 4);
  EXPECT_NEAR(near[kCentre], 0.75F, 1e-6);
  EXPECT_NEAR(near[kWidth], 0.25F + kOctaves, 1e-6);
}

// A rope that runs towards the camera: 6 px wide for most of its length, then up to 34.
struct Approaching {
  static constexpr int kImageWidth = 640;
  static constexpr int kImageHeight = 200;
  static constexpr float kRow = 100;

  static float width_at(float u) { return u < 380 ? 6 : 6 + (u - 380) * 28 / 240; }

  Approaching() {
    for (int v = 0; v < kImageHeight; ++v) {
      for (int u = 0; u < kImageWidth; ++u) {
        const float off = static_cast<float>(v) - kRow;
        const float width = width_at(static_cast<float>(u));
        const bool on = u >= 20 && u < 620 && std::abs(off) <= 0.5F * width;
        const float round = on ? std::sqrt(1 - 4 * off * off / (width * width)) : 0.0F;
        mask.push_back(on ? 255 : 0);
        depth_m.push_back(3.0F / width - (on ? 0.005F * round : -0.005F));
        for (const float albedo : {60.0F, 90.0F, 200.0F}) {
          color.push_back(static_cast<std::uint8_t>(on ? albedo * (0.4F + 0.6F * round) : 150));
        }
      }
    }
  }
  Frame frame() const {
    return {kImageWidth, kImageHeight, {600, 600, 320, 100}, depth_m, mask, color};
  }

  std::vector<float> depth_m;
  std::vector<std::uint8_t> mask;
  std::vector<std::uint8_t> color;
};

TEST(NearParts, ARopeThatComesNearHasOneLineAllAlong) {
  auto weights = weights::load_field(FLOWDLO_FIELD_WEIGHTS);
  ASSERT_TRUE(weights) << weights.error().message;
  auto network = Network::create(std::make_shared<const weights::FieldWeights>(*std::move(weights)),
                                 [] { return reference::create_program(1); });
  ASSERT_TRUE(network);
  const Approaching scene;
  const auto seen = see(scene.frame(), 6, *network, true);
  ASSERT_TRUE(seen) << seen.error().message;
  for (int u = 40; u < 600; u += 10) {
    int lines = 0;
    for (const AxisLine& line : axes(*seen).lines) {
      float nearest = 1000;
      float off = 0;
      for (const auto& p : line.points_px) {
        const float away = std::abs(p.x() - static_cast<float>(u));
        if (away >= nearest) continue;
        nearest = away;
        off = std::abs(p.y() - Approaching::kRow);
      }
      if (nearest > 2) continue;
      ++lines;
      EXPECT_LT(off, 0.25F * Approaching::width_at(static_cast<float>(u))) << "column " << u;
    }
    EXPECT_EQ(lines, 1) << "column " << u;
  }
}

}  // namespace
}  // namespace flowdlo::field
