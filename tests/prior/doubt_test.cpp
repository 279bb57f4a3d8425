// How far refine says that its nodes may be off.
#include "prior/refined_prior.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "prior/drawn_rope.hpp"

namespace flowdlo::prior {
namespace {

using testing::crossing_line;
using testing::cut_off_square;
using testing::draw_rope;
using testing::DrawnRope;
using testing::erase_depth;
using testing::kRadius_m;
using testing::refined;
using testing::straight_line;

TEST(Refine, GivesASigmaThatGrowsFromWhatIsSeen) {
  DrawnRope rope = draw_rope(straight_line());
  erase_depth(rope, 320, 640);
  const Prior prior = refined(rope);
  EXPECT_LT(5 * prior.sigma_m[5], prior.sigma_m.back());
  for (std::size_t i = 40; i + 1 < prior.nodes.size(); ++i) {
    EXPECT_LT(prior.sigma_m[i], prior.sigma_m[i + 1]) << "node " << i;
  }
}

TEST(Refine, IsAsSureOfASquareTipAsOfARoundOne) {
  const float round_m = refined(draw_rope(straight_line())).sigma_m.front();
  DrawnRope cut = cut_off_square();
  for (int v = 0; v < cut.image.height; ++v) {  // nothing of it shows beyond
    for (int u = 0; u < cut.image.width; ++u) {
      if (cut.image.mask[cut.index(u, v)] == 0) cut.image.depth_m[cut.index(u, v)] = 2;
    }
  }
  const Prior square = refined(cut);
  EXPECT_LT(round_m, 0.3 * kRadius_m);
  EXPECT_LT(square.sigma_m.front(), 0.6 * kRadius_m);
  EXPECT_LT(square.sigma_m.back(), 0.6 * kRadius_m);
}

TEST(Refine, DoubtsATipThatPointsAwayFromTheCamera) {  // both in plain sight
  const Prior across = refined(draw_rope(straight_line()));
  const Prior away = refined(draw_rope({{-0.12, 0.02, 0.75}, {0.06, 0.03, 0.45}}));
  EXPECT_GT(away.sigma_m.front(), 2 * across.sigma_m.front());
}

TEST(Refine, DoubtsTheTipsOfAFrayedMask) {
  DrawnRope rope = draw_rope(straight_line());
  const float clean_m = refined(rope).sigma_m.front();
  for (int u = 0; u < rope.image.width; ++u) {  // 10 px a wave, up to 3 px to both sides
    const int reach = static_cast<int>(std::lround(1.5 * (1 + std::sin(0.6 * u))));
    std::vector<std::uint8_t> column;
    for (int v = 0; v < rope.image.height; ++v) column.push_back(rope.image.mask[rope.index(u, v)]);
    for (int v = reach; v + reach < rope.image.height; ++v) {
      for (int off = -reach; off <= reach; ++off) {
        if (column[static_cast<std::size_t>(v + off)] > 127)
          rope.image.mask[rope.index(u, v)] = 255;
      }
    }
  }
  EXPECT_GT(refined(rope).sigma_m.front(), 1.5 * clean_m);
}

TEST(Refine, DoubtsTheNodesNearAnEndOutsideOfTheImage) {
  const Prior prior = refined(draw_rope({{-0.2, -0.004, 0.6}, {0.4, 0.008, 0.6}}));
  EXPECT_GT(prior.sigma_m.back(), 0.01F);
  EXPECT_LT(prior.sigma_m.front(), 0.003F);
  EXPECT_LT(prior.sigma_m[20], prior.sigma_m[50]);
}

// Of ropes of slightly different lengths, so that some node lies in the middle of what is unseen.
TEST(Refine, TrustsAHiddenStrandLessThanAnEquallyLongHole) {
  float hidden_m = 0;
  float erased_m = 0;
  for (double more = 0; more < 0.02; more += 0.004) {
    lab::Curve3 curve = crossing_line(0.63);
    curve.emplace_back(0, 0.15 + more, 0.63);
    const Prior crossing = refined(draw_rope(curve));
    DrawnRope hole = draw_rope({{0, -0.2, 0.63}, {0, 0.15 + more, 0.63}});
    for (int v = 234; v < 247; ++v) {
      for (int u = 0; u < 640; ++u) hole.image.depth_m[hole.index(u, v)] = 0;
    }
    const Prior erased = refined(hole);
    hidden_m =
        std::max(hidden_m, *std::max_element(crossing.sigma_m.begin(), crossing.sigma_m.end()));
    erased_m = std::max(erased_m, *std::max_element(erased.sigma_m.begin(), erased.sigma_m.end()));
  }
  EXPECT_GT(hidden_m, 1.2F * erased_m);
}

}  // namespace
}  // namespace flowdlo::prior
