// Whether a mask is one rope, on pictures drawn by hand and on drawn scenes. By hand: a table half
// a metre away, f = 320, a rope 10 px wide (15 mm) along the row kRow.
#include "gate/one_rope.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "one_rope/two_ropes.hpp"
#include "scene/scene.hpp"

namespace flowdlo::gate {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr int kRow = 120;
constexpr Intrinsics kCamera{320, 320, 160, 120};
constexpr float kTable_m = 0.5F;
constexpr float kRope_px = 10;
constexpr float kRadius_m = 0.5F * kRope_px * kTable_m / 320;

struct Picture {
  std::vector<float> depth_m = std::vector<float>(std::size_t{kWidth} * kHeight, kTable_m);
  std::vector<std::uint8_t> mask = std::vector<std::uint8_t>(std::size_t{kWidth} * kHeight, 0);

  /// A bar `half_px` to either side of kRow.
  Picture& bar(int from, int to, int half_px, float depth_m_of_it) {
    for (int v = kRow - half_px; v < kRow + half_px; ++v) {
      for (int u = from; u < to; ++u) depth_m[at(u, v)] = depth_m_of_it;
    }
    return *this;
  }
  Picture& rope(int from, int to) { return bar(from, to, 5, kTable_m - 2 * kRadius_m); }
  Picture& mark(int from, int to) {
    for (int v = kRow - 5; v < kRow + 5; ++v) {
      for (int u = from; u < to; ++u) mask[at(u, v)] = 255;
    }
    return *this;
  }
  [[nodiscard]] Frame frame() const { return {kWidth, kHeight, kCamera, depth_m, mask, {}}; }

 private:
  static std::size_t at(int u, int v) { return static_cast<std::size_t>(v * kWidth + u); }
};

/// Along kRow, on the rope's axis.
Centerline nodes_along(float from_px, float to_px) {
  Centerline nodes{};
  const float z = kTable_m - kRadius_m;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const float u = from_px + (to_px - from_px) * static_cast<float>(i) / (kNodes - 1);
    nodes[i] = {(u - kCamera.cx) * z / kCamera.fx, (kRow - 0.5F - kCamera.cy) * z / kCamera.fy, z};
  }
  return nodes;
}

std::vector<Doubt> doubts(const Picture& picture, float from_px, float to_px) {
  return one_rope(nodes_along(from_px, to_px), picture.frame(), kRope_px).doubts;
}

TEST(OneRope, AStripThatTheNodesFollowHasNoDoubt) {
  const auto one =
      one_rope(nodes_along(45, 275), Picture().rope(40, 280).mark(40, 280).frame(), kRope_px);
  EXPECT_THAT(one.doubts, IsEmpty());
  EXPECT_GT(one.explained, 0.99F);
  EXPECT_NEAR(one.slender, 23, 1);
  EXPECT_EQ(one.sides, 1);
  EXPECT_EQ(one.even, 1);
  EXPECT_EQ(one.left_over, 0);
  EXPECT_EQ(one.off_mask, 0);
  EXPECT_EQ(one.bare_gap, 0);
  EXPECT_EQ(one.goes_on, 0);
}

TEST(OneRope, AMaskThatIsFullIsNoRopeWhateverItsSize) {
  for (const auto& [width, height] :
       std::vector<std::pair<int, int>>{{64, 64}, {320, 240}, {640, 480}, {640, 40}, {4096, 16}}) {
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    const std::vector<float> depth_m(pixels, 0.5F);
    const std::vector<std::uint8_t> mask(pixels, 255);
    const auto w = static_cast<float>(width);
    const auto h = static_cast<float>(height);
    Centerline nodes{};
    for (std::size_t i = 0; i < kNodes; ++i) {
      nodes[i] = {0.5F * (static_cast<float>(i) / (kNodes - 1) - 0.5F), 0, 0.5F};
    }
    const Frame frame{width, height, {w, w, w / 2, h / 2}, depth_m, mask, {}};
    EXPECT_THAT(one_rope(nodes, frame, h).doubts, Contains(Doubt::kNoRope))
        << width << " x " << height;
  }
}

TEST(OneRope, MaskThatTheNodesLeaveOutIsAStrandLeft) {
  const auto picture = Picture().rope(40, 280).mark(40, 280);
  EXPECT_THAT(doubts(picture, 45, 160), Contains(Doubt::kStrandsLeft));
}

TEST(OneRope, AJumpOverPlainTableIsABareGap) {
  const auto picture = Picture().rope(40, 120).rope(200, 280).mark(40, 120).mark(200, 280);
  EXPECT_THAT(doubts(picture, 45, 275), ElementsAre(Doubt::kBareGap));
}

TEST(OneRope, AGapBehindAnOccluderIsNone) {
  auto picture = Picture().rope(40, 280).mark(40, 120).mark(200, 280);
  picture.bar(120, 200, 60, 0.3F);
  EXPECT_THAT(doubts(picture, 45, 275), IsEmpty());
}

TEST(OneRope, ACutInTheMaskAloneIsNone) {
  EXPECT_THAT(doubts(Picture().rope(40, 280).mark(40, 120).mark(200, 280), 45, 275), IsEmpty());
}

TEST(OneRope, ARopeThatIsSeenBeyondItsMaskGoesOn) {
  const auto picture = Picture().rope(40, 280).mark(40, 160);
  EXPECT_THAT(doubts(picture, 45, 155), ElementsAre(Doubt::kGoesOn));
  EXPECT_THAT(doubts(picture, 155, 45), ElementsAre(Doubt::kGoesOn)) << "whichever end comes first";
}

TEST(OneRope, SomethingWiderBeyondTheMaskIsAGripper) {
  auto picture = Picture().rope(40, 160).mark(40, 160);
  picture.bar(160, 280, 10, kTable_m - 2 * kRadius_m);
  EXPECT_THAT(doubts(picture, 45, 155), IsEmpty());
}

TEST(OneRope, SomethingNearerBeyondTheMaskHidesIt) {
  auto picture = Picture().rope(40, 160).mark(40, 160);
  picture.bar(160, 280, 5, kTable_m - 8 * kRadius_m);
  EXPECT_THAT(doubts(picture, 45, 155), IsEmpty());
}

TEST(OneRope, AMaskThatEndsAtTheImagesBorderIsWhole) {
  EXPECT_THAT(doubts(Picture().rope(40, kWidth).mark(40, kWidth), 45, kWidth - 1), IsEmpty());
}

TEST(OneRope, NodesThatCannotBeDrawnAreNoRope) {
  auto nodes = nodes_along(45, 275);
  nodes[7].z = std::numeric_limits<float>::quiet_NaN();
  const Picture picture = Picture().rope(40, 280).mark(40, 280);
  EXPECT_THAT(one_rope(nodes, picture.frame(), kRope_px).doubts, ElementsAre(Doubt::kNoRope));
}

TEST(Doubted, LowersAConfidenceAndNeverRaisesOne) {
  OneRope one;
  EXPECT_EQ(doubted(0.9F, one), 0.9F);
  one.doubts = {Doubt::kGoesOn};
  EXPECT_LT(doubted(0.9F, one), 0.3F);
  EXPECT_EQ(doubted(0.1F, one), 0.1F);
}

constexpr std::uint64_t kSeed = 8000100;

struct Drawn {
  FrameFolder frame;
  float width_px = 0;
};

Drawn drawn(lab::Kind kind, std::uint64_t seed) {
  auto scene = lab::make_scene(kind, seed);
  Drawn drawn;
  drawn.width_px =
      2 * static_cast<float>(scene.radius_m) * scene.image.camera.fx / scene.truth[kNodes / 2].z;
  drawn.frame.width = scene.image.width;
  drawn.frame.height = scene.image.height;
  drawn.frame.intrinsics = scene.image.camera;
  drawn.frame.depth_m = std::move(scene.image.depth_m);
  drawn.frame.mask = std::move(scene.image.mask);
  drawn.frame.truth = scene.truth;
  return drawn;
}

class DrawnScene : public ::testing::TestWithParam<int> {};

TEST_P(DrawnScene, WithItsTrueNodesHasNoDoubt) {
  const auto scene = drawn(static_cast<lab::Kind>(GetParam()), kSeed);
  EXPECT_THAT(one_rope(*scene.frame.truth, scene.frame.frame(), scene.width_px).doubts, IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Kinds, DrawnScene, ::testing::Range(0, lab::kKinds));

TEST(DrawnScenes, OfTwoRopesOfWhichTheNodesFollowOneHaveStrandsLeft) {
  const auto first = drawn(lab::Kind::kSimple, kSeed);
  const auto second = drawn(lab::Kind::kSimple, kSeed + 50);
  for (int k = 0; k < lab::kArrangements; ++k) {
    const auto arrangement = static_cast<lab::Arrangement>(k);
    const auto pair = lab::two_ropes(first.frame, second.frame, arrangement, kSeed);
    if (!pair) continue;
    const float width_px = lab::kTwoRopesScale * first.width_px;
    EXPECT_THAT(one_rope(*pair->truth, pair->frame(), width_px).doubts,
                Contains(Doubt::kStrandsLeft))
        << lab::name_of(arrangement);
  }
}

}  // namespace
}  // namespace flowdlo::gate
