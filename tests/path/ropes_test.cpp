// Several ropes of one mask, on scenes with truth: which share of each kind has to be right is
// flowdlo-lab ropes-report's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "flowdlo/config.hpp"
#include "path/path.hpp"
#include "scene/ropes.hpp"
#include "scene/setting.hpp"

namespace flowdlo::path {
namespace {

using lab::make_ropes;
using lab::RopesKind;
using lab::RopesScene;
using testing::HasSubstr;

// How far a path's ends are from the ends of the rope that they are nearest to, pixels.
double ends_off_px(const Path& path, const RopesScene& scene) {
  double least = 1e9;
  const Eigen::Vector2d a = path.points_px.front().cast<double>();
  const Eigen::Vector2d b = path.points_px.back().cast<double>();
  for (const auto& rope : scene.ropes) {
    const auto first = lab::project(scene.image.camera, rope.curve.front());
    const auto last = lab::project(scene.image.camera, rope.curve.back());
    least = std::min({least, std::max((a - first).norm(), (b - last).norm()),
                      std::max((b - first).norm(), (a - last).norm())});
  }
  return least;
}

// A path along a straight line.
Path line(const Eigen::Vector2f& from, const Eigen::Vector2f& to) {
  Path path;
  for (int i = 0; i <= 100; ++i) {
    path.points_px.emplace_back(from + (to - from) * static_cast<float>(i) / 100);
  }
  path.bridged.assign(path.points_px.size(), 0);
  return path;
}

TEST(RopePaths, OneRopeIsTheSameInEitherDirectionAndNoneThatEndsElsewhere) {
  const Path rope = line({10, 10}, {200, 40});
  EXPECT_TRUE(same_rope(rope, line({12, 14}, {198, 37}), 8));
  EXPECT_TRUE(same_rope(rope, line({200, 40}, {10, 10}), 8));
  EXPECT_FALSE(same_rope(rope, line({10, 10}, {150, 32}), 8));
  EXPECT_FALSE(same_rope(rope, line({10, 30}, {200, 60}), 8));
  Path ring = line({10, 10}, {200, 40});
  ring.closed = true;
  EXPECT_FALSE(same_rope(rope, ring, 8));
  Path turned = ring;
  std::rotate(turned.points_px.begin(), turned.points_px.begin() + 30, turned.points_px.end());
  EXPECT_TRUE(same_rope(ring, turned, 8));
}

// Whether both sets are the same ropes.
bool same_ropes(const std::vector<Path>& a, const std::vector<Path>& b, float width_px) {
  return a.size() == b.size() && std::all_of(a.begin(), a.end(), [&](const Path& rope) {
           return std::any_of(b.begin(), b.end(),
                              [&](const Path& other) { return same_rope(rope, other, width_px); });
         });
}

// A frame that might as well show another set of ropes, and both sets.
struct Ambiguous {
  RopesScene scene;
  RopePaths traced;
  std::vector<Path> other;
};

std::optional<Ambiguous> ambiguous() {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    auto scene = make_ropes(RopesKind::kCrossing, 4, seed);
    auto traced = trace_ropes(scene.frame(), 0);
    if (!traced || traced->guesses.size() < 2) continue;
    auto other = traced->guesses[1].ropes;
    if (same_ropes(traced->ropes, other, traced->rope_width_px)) continue;
    return Ambiguous{std::move(scene), *std::move(traced), std::move(other)};
  }
  return std::nullopt;
}

TEST(RopePaths, TheFrameBeforeDecidesBetweenSetsThatThisOneHardlyTellsApart) {
  const auto seen = ambiguous();
  ASSERT_TRUE(seen) << "no scene might be two sets of ropes";
  const float width_px = seen->traced.rope_width_px;
  const auto told = trace_ropes(seen->scene.frame(), 0, seen->other);
  ASSERT_TRUE(told) << told.error().message;
  EXPECT_TRUE(same_ropes(told->ropes, seen->other, width_px));
  EXPECT_LE(*std::min_element(told->lead.begin(), told->lead.end()), 0)
      << "by this frame alone another set is cheaper";
  EXPECT_EQ(told->guesses.front().share, seen->traced.guesses.front().share);
}

TEST(RopePaths, AFrameBeforeWhoseRopesLieElsewhereIsNoEvidence) {
  const auto seen = ambiguous();
  ASSERT_TRUE(seen) << "no scene might be two sets of ropes";
  const float width_px = seen->traced.rope_width_px;
  auto moved = seen->other;
  for (Path& rope : moved) {
    for (auto& p : rope.points_px) p.x() += 4 * width_px;
  }
  const auto told = trace_ropes(seen->scene.frame(), 0, moved);
  ASSERT_TRUE(told) << told.error().message;
  EXPECT_TRUE(same_ropes(told->ropes, seen->traced.ropes, width_px));
  EXPECT_EQ(told->lead, seen->traced.lead);
}

TEST(RopePaths, NoFrameBeforeOutvotesAClearOne) {
  const auto scene = make_ropes(RopesKind::kCrossing, 2, 0);
  const auto alone = trace_ropes(scene.frame(), 0);
  ASSERT_TRUE(alone) << alone.error().message;
  ASSERT_EQ(alone->ropes.size(), 2U);
  const auto& a = alone->ropes[0].points_px;
  const auto& b = alone->ropes[1].points_px;
  const auto told =
      trace_ropes(scene.frame(), 0, {line(a.front(), b.back()), line(b.front(), a.back())});
  ASSERT_TRUE(told) << told.error().message;
  EXPECT_TRUE(same_ropes(told->ropes, alone->ropes, alone->rope_width_px));
}

TEST(RopePaths, AsManyAsThereAreWithTheirEndsWhereTheirsAre) {
  for (int ropes = 2; ropes <= 5; ++ropes) {
    const auto scene = make_ropes(RopesKind::kCrossing, ropes, 0);
    const auto traced = trace_ropes(scene.frame(), 0);
    ASSERT_TRUE(traced) << traced.error().message;
    ASSERT_EQ(static_cast<int>(traced->ropes.size()), ropes);
    for (const Path& path : traced->ropes) {
      EXPECT_LT(ends_off_px(path, scene), 12) << ropes << " ropes";
      EXPECT_FALSE(path.closed);
    }
    EXPECT_EQ(traced->lead.size(), traced->ropes.size());
  }
}

TEST(RopePaths, GapsBelowTheUpperRopeAreBridged) {
  const auto scene = make_ropes(RopesKind::kGaps, 3, 1);
  const auto traced = trace_ropes(scene.frame(), 0);
  ASSERT_TRUE(traced) << traced.error().message;
  ASSERT_EQ(traced->ropes.size(), 3U);
  const bool bridged =
      std::any_of(traced->ropes.begin(), traced->ropes.end(), [](const Path& path) {
        return std::count(path.bridged.begin(), path.bridged.end(), std::uint8_t{1}) > 0;
      });
  EXPECT_TRUE(bridged);
}

TEST(RopePaths, GapsOfAPixelOrTwoWhereTheyCrossPartNoRope) {
  int right = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const auto scene = make_ropes(RopesKind::kGaps, 3, seed);
    const auto traced = trace_ropes(scene.frame(), 0);
    ASSERT_TRUE(traced) << seed;
    right += traced->ropes.size() == scene.ropes.size() ? 1 : 0;
  }
  EXPECT_GE(right, 5);
}

TEST(RopePaths, ARingIsClosedThoughARopeCrossesIt) {
  const auto scene = make_ropes(RopesKind::kRings, 2, 0);
  const auto traced = trace_ropes(scene.frame(), 0);
  ASSERT_TRUE(traced) << traced.error().message;
  ASSERT_EQ(traced->ropes.size(), 2U);
  EXPECT_EQ(std::count_if(traced->ropes.begin(), traced->ropes.end(),
                          [](const Path& path) { return path.closed; }),
            1);
  for (const Path& path : traced->ropes) {
    if (!path.closed) continue;
    EXPECT_LT((path.points_px.front() - path.points_px.back()).norm(), 12);
  }
}

TEST(RopePaths, TheNumberMayBeGiven) {
  const auto scene = make_ropes(RopesKind::kCrossing, 3, 0);
  const auto traced = trace_ropes(scene.frame(), 3);
  ASSERT_TRUE(traced) << traced.error().message;
  EXPECT_EQ(traced->ropes.size(), 3U);
}

TEST(RopePaths, MoreRopesThanTheMaskCanBeIsAnErrorThatSaysSo) {
  const auto scene = make_ropes(RopesKind::kCrossing, 2, 0);
  const auto traced = trace_ropes(scene.frame(), kMostRopes);
  ASSERT_FALSE(traced);
  EXPECT_EQ(traced.error().code, ErrorCode::kNoPath);
  EXPECT_THAT(traced.error().message, HasSubstr("expected a mask of 32 ropes"));
}

TEST(RopePaths, MoreThanAnyoneCanTellApartIsAnError) {
  auto scene = make_ropes(RopesKind::kCrossing, 2, 0);
  auto& mask = scene.image.mask;
  std::fill(mask.begin(), mask.end(), std::uint8_t{0});
  scene.image.depth_m.assign(mask.size(), 2.0F);
  for (int k = 0; k < kMostRopes + 4; ++k) {  // bars in two rows
    const int left = 12 + 34 * (k / 2);
    const int top = k % 2 == 0 ? 30 : 260;
    for (int v = top; v < top + 180; ++v) {
      for (int u = left; u < left + 8; ++u) {
        const std::size_t p =
            static_cast<std::size_t>(v) * static_cast<std::size_t>(scene.image.width) +
            static_cast<std::size_t>(u);
        mask[p] = 255;
        scene.image.depth_m[p] = 0.5F;
      }
    }
  }
  const auto traced = trace_ropes(scene.frame(), 0);
  ASSERT_FALSE(traced);
  EXPECT_THAT(traced.error().message, HasSubstr("at most 32 ropes"));
}

// A straight rope with a hole in it, in front of which a thing lies at the rope's own depth.
TEST(RopePaths, AnotherRopesLabelHidesWhatTheDepthDoesNot) {
  constexpr int kWidth = 320;
  constexpr int kHeight = 120;
  std::vector<float> depth_m(kWidth * kHeight, 0.55F);
  std::vector<std::uint8_t> mask(depth_m.size(), 0);
  std::vector<std::uint16_t> labels(depth_m.size(), 0);
  for (int v = 56; v < 64; ++v) {
    for (int u = 20; u < 300; ++u) {
      const bool hole = u >= 130 && u < 190;
      const auto p = static_cast<std::size_t>(v) * kWidth + static_cast<std::size_t>(u);
      if (!hole) mask[p] = 255;
      if (!hole) depth_m[p] = 0.5F;
      labels[p] = hole ? 7 : 0;
    }
  }
  Frame frame{kWidth, kHeight, {300, 300, 160, 60}, depth_m, mask, {}};
  const auto open = trace_ropes(frame, 0);
  ASSERT_TRUE(open) << open.error().message;
  EXPECT_EQ(open->ropes.size(), 2U);  // background shows in the hole
  frame.instances = labels;
  const auto hidden = trace_ropes(frame, 0);
  ASSERT_TRUE(hidden) << hidden.error().message;
  EXPECT_EQ(hidden->ropes.size(), 1U);
  const auto two = trace_ropes(frame, 2);
  ASSERT_TRUE(two) << two.error().message;
  for (const Path& path : two->ropes) EXPECT_EQ(path.hidden_ends, 0.5F);
}

TEST(RopePaths, AnEmptyMaskIsAnError) {
  auto scene = make_ropes(RopesKind::kCrossing, 2, 0);
  std::fill(scene.image.mask.begin(), scene.image.mask.end(), std::uint8_t{0});
  for (const int ropes : {0, 1, 4}) {
    const auto traced = trace_ropes(scene.frame(), ropes);
    ASSERT_FALSE(traced);
    EXPECT_EQ(traced.error().code, ErrorCode::kNoPath);
  }
}

}  // namespace
}  // namespace flowdlo::path
