// A mask that grows from clicks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <limits>
#include <vector>

#include "flowdlo/mask.hpp"
#include "mask/table_scene.hpp"

namespace flowdlo {
namespace {

using ::testing::HasSubstr;
using testing::overlap;
using testing::TableScene;

Pixel on_axis(int u) { return {static_cast<float>(u), TableScene::axis_v(u)}; }

/// A second rope of the same colour below, which touches nothing.
Mask add_straight_rope(TableScene& scene) {
  Mask other(scene.rope.size(), 0);
  for (int v = 210; v < 219; ++v) {
    for (int u = 40; u < 280; ++u) {
      other[TableScene::at(u, v)] = 255;
      scene.paint(TableScene::at(u, v), 200, 30, 40);
    }
  }
  return other;
}

TEST(MaskFromSeeds, IsTheRopeThatWasClickedOn) {
  TableScene scene;
  const Mask other = add_straight_rope(scene);
  const auto one = mask_from_seeds(scene.frame(), std::vector{on_axis(100)});
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_GT(overlap(*one, scene.rope), 0.99);
  const auto second = mask_from_seeds(scene.frame(), std::vector{Pixel{60, 214}});
  ASSERT_TRUE(second);
  EXPECT_GT(overlap(*second, other), 0.97);
  Mask both = scene.rope;
  for (std::size_t i = 0; i < both.size(); ++i) both[i] |= other[i];
  const auto two = mask_from_seeds(scene.frame(), std::vector{on_axis(100), Pixel{60, 214}});
  ASSERT_TRUE(two);
  EXPECT_GT(overlap(*two, both), 0.98);
}

TEST(MaskFromSeeds, TakesARopeOfTwoColoursFromTwoClicks) {
  TableScene scene;
  for (int v = 0; v < TableScene::kHeight; ++v) {
    for (int u = 160; u < TableScene::kWidth; ++u) {
      const auto pixel = TableScene::at(u, v);
      if (scene.rope[pixel] != 0) scene.paint(pixel, 30, 60, 190);
    }
  }
  const auto mask = mask_from_seeds(scene.frame(), std::vector{on_axis(100), on_axis(250)});
  ASSERT_TRUE(mask);
  EXPECT_GT(overlap(*mask, scene.rope), 0.98);
}

TEST(MaskFromSeeds, EndsAtAStepInDepthWhereColourDoesNot) {
  TableScene scene;
  for (int v = 0; v < TableScene::kHeight; ++v) {
    for (int u = 0; u < TableScene::kWidth; ++u) {
      const auto pixel = TableScene::at(u, v);
      scene.paint(pixel, 200, 30, 40);
      if (scene.rope[pixel] != 0) scene.depth_m[pixel] -= 0.05F;  // it hangs above a red table
    }
  }
  const auto mask = mask_from_seeds(scene.frame(), std::vector{on_axis(100)});
  ASSERT_TRUE(mask);
  EXPECT_GT(overlap(*mask, scene.rope), 0.99);
  Frame flat = scene.frame();
  flat.depth_m = {};
  EXPECT_LT(overlap(*mask_from_seeds(flat, std::vector{on_axis(100)}), scene.rope), 0.2);
}

TEST(MaskFromSeeds, GrowsOverWhatWasNotMeasured) {
  TableScene scene;
  scene.depth_m.assign(scene.depth_m.size(), std::numeric_limits<float>::quiet_NaN());
  const auto mask = mask_from_seeds(scene.frame(), std::vector{on_axis(100)});
  ASSERT_TRUE(mask);
  EXPECT_GT(overlap(*mask, scene.rope), 0.99);
}

TEST(MaskFromSeeds, TakesSeedsInEveryCorner) {
  TableScene scene;
  std::vector<Pixel> corners;
  for (const float u : {0.0F, TableScene::kWidth - 1.0F}) {
    for (const float v : {0.0F, TableScene::kHeight - 1.0F}) corners.push_back({u, v});
  }
  EXPECT_TRUE(mask_from_seeds(scene.frame(), corners));
}

TEST(MaskFromSeeds, NamesEveryFault) {
  const TableScene scene;
  const float none = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Pixel> outside{{-1, 5}, {5, 240}, {none, 3}};
  const auto mask = mask_from_seeds(
      scene.frame(), outside, {.tolerance = none, .lightness_tolerance = 3, .depth_step_m = 0});
  ASSERT_FALSE(mask);
  EXPECT_EQ(mask.error().code, ErrorCode::kBadInput);
  for (const char* what :
       {"got (-1, 5)", "got (5, 240)", "got (nan, 3)", "SeedGrowth.tolerance",
        "lightness_tolerance: expected more than 0 and at most 2, got 3", "depth_step_m"}) {
    EXPECT_THAT(mask.error().message, HasSubstr(what));
  }
  EXPECT_THAT(mask_from_seeds(scene.frame(), {}).error().message, HasSubstr("1 to 256 seeds"));
}

/// Everything of it hangs together for a seed anywhere, and hardly two seeds have one colour.
TableScene faintly_coloured() {
  TableScene scene;
  for (std::size_t pixel = 0; pixel < scene.rope.size(); ++pixel) {
    const auto words = random::philox(11, pixel);
    const auto shade = [&](std::size_t channel) {
      return 120 + static_cast<int>(words[channel] % 40);
    };
    scene.paint(pixel, shade(0), shade(1), shade(2));
  }
  return scene;
}

std::vector<Pixel> scattered(std::size_t count) {
  std::vector<Pixel> seeds;
  for (std::size_t i = 0; i < count; ++i) {
    const auto words = random::philox(13, i);
    seeds.push_back({static_cast<float>(words[0] % TableScene::kWidth),
                     static_cast<float>(words[1] % TableScene::kHeight)});
  }
  return seeds;
}

double processor_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

TEST(MaskFromSeeds, ManySeedsThatReachEverythingAreRefusedInTheTimeOfAFew) {
  const TableScene scene = faintly_coloured();
  const SeedGrowth wide{.tolerance = 2, .lightness_tolerance = 2, .depth_step_m = 10};
  const auto took_s = [&](std::size_t count) {
    const auto seeds = scattered(count);
    double least_s = std::numeric_limits<double>::max();
    for (int turn = 0; turn < 3; ++turn) {
      const double before_s = processor_s();
      const auto mask = mask_from_seeds(scene.frame(), seeds, wide);
      least_s = std::min(least_s, processor_s() - before_s);
      EXPECT_EQ(mask.has_value(), count == 1);
      if (!mask) {
        EXPECT_THAT(mask.error().message, HasSubstr("click on the rope alone"));
      }
    }
    return least_s;
  };
  const double one_s = took_s(1);
  EXPECT_LE(took_s(kMostSeeds), 16 * one_s);
}

TEST(MaskFromSeeds, ManySeedsOfOneColourGrowAsOne) {
  TableScene scene;
  for (std::size_t pixel = 0; pixel < scene.rope.size(); ++pixel) scene.paint(pixel, 200, 30, 40);
  const SeedGrowth growth{.depth_step_m = 10};
  const auto mask = mask_from_seeds(scene.frame(), scattered(kMostSeeds), growth);
  ASSERT_TRUE(mask) << mask.error().message;
  EXPECT_EQ(testing::pixels_of(*mask), mask->size());
}

TEST(MaskFromSeeds, ASeedTwiceIsOne) {
  const TableScene scene;
  const auto once = mask_from_seeds(scene.frame(), std::vector{on_axis(100)});
  const auto twice = mask_from_seeds(scene.frame(), std::vector{on_axis(100), on_axis(100)});
  ASSERT_TRUE(once && twice);
  EXPECT_EQ(*once, *twice);
}

}  // namespace
}  // namespace flowdlo
