// Several ropes of one frame, from end to end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "estimator/parted.hpp"
#include "estimator/rope_views.hpp"
#include "flowdlo/estimator.hpp"
#include "geometry/polyline.hpp"
#include "scene/ropes.hpp"
#include "scene/scene.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo {
namespace {

using lab::make_ropes;
using lab::RopesKind;
using ::testing::HasSubstr;
using testing::WaveFrame;

Estimator make(int ropes, int threads = 1, const char* field_weights = "") {
  Config config{.weights = FLOWDLO_WEIGHTS, .device = "cpu", .euler_steps = 1, .draws = 1};
  config.ropes = ropes;
  config.threads = threads;
  config.field_weights = field_weights;
  auto estimator = Estimator::create(config);
  if (!estimator) throw std::runtime_error(estimator.error().message);
  return *std::move(estimator);
}

Estimator make_with_field(int ropes) { return make(ropes, 1, FLOWDLO_FIELD_WEIGHTS); }

Ropes estimate(Estimator& estimator, const Frame& frame) {
  auto ropes = estimator.estimate_ropes(frame);
  if (!ropes) throw std::runtime_error(ropes.error().message);
  return *std::move(ropes);
}

/// Takes the depth of a labelled rope, or of all that is no rope, away.
void hide(std::uint16_t label, lab::RopesScene& scene) {
  for (std::size_t p = 0; p < scene.image.depth_m.size(); ++p) {
    if (scene.image.instances[p] == label) scene.image.depth_m[p] = 0;
  }
}

Frame labelled(const lab::RopesScene& scene) {
  Frame frame = scene.frame();
  frame.instances = scene.image.instances;
  return frame;
}

TEST(EstimateRopes, EveryRopeIsFoundLongestFirst) {
  const auto scene = make_ropes(RopesKind::kCrossing, 3, 0);
  auto estimator = make(0);
  const Ropes found = estimate(estimator, scene.frame());
  ASSERT_EQ(found.ropes.size(), 3U);
  std::vector<double> true_m;
  std::vector<double> found_m;
  for (const auto& rope : scene.ropes) {
    true_m.push_back(static_cast<double>(geometry::length(rope.truth)));
  }
  for (const auto& rope : found.ropes) {
    found_m.push_back(static_cast<double>(geometry::length(rope.nodes)));
  }
  EXPECT_TRUE(std::is_sorted(found_m.rbegin(), found_m.rend()));
  std::sort(true_m.rbegin(), true_m.rend());
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found_m[i], true_m[i], 0.1 * true_m[i]);
}

TEST(EstimateRopes, OneRopeIsTheSameToTheBitAsEstimate) {
  const WaveFrame wave;
  auto estimator = make(1);
  const auto alone = estimator.estimate(wave.frame());
  ASSERT_TRUE(alone) << alone.error().message;
  const Ropes found = estimate(estimator, wave.frame());
  ASSERT_EQ(found.ropes.size(), 1U);
  EXPECT_EQ(found.ropes[0].nodes, alone->nodes);
  EXPECT_EQ(found.ropes[0].sigma_m, alone->sigma_m);
  EXPECT_EQ(found.ropes[0].confidence, alone->confidence);
}

TEST(EstimateRopes, EveryPixelOfTheMaskIsOneRopes) {
  const auto scene = make_ropes(RopesKind::kCrossing, 2, 1);
  auto estimator = make(2);
  const Ropes found = estimate(estimator, scene.frame());
  ASSERT_EQ(found.instances.size(), scene.image.mask.size());
  std::size_t right = 0;
  std::size_t swapped = 0;
  std::size_t pixels = 0;
  for (std::size_t p = 0; p < found.instances.size(); ++p) {
    ASSERT_EQ(found.instances[p] != 0, scene.image.mask[p] > 127);
    if (found.instances[p] == 0) continue;
    ++pixels;
    right += found.instances[p] == scene.image.instances[p] ? 1 : 0;
    swapped += found.instances[p] + scene.image.instances[p] == 3 ? 1 : 0;
  }
  EXPECT_GT(std::max(right, swapped), pixels * 98 / 100);
}

TEST(EstimateRopes, TheUpperRopeOfACrossingIsToldAndWhere) {
  const auto scene = make_ropes(RopesKind::kHanging, 2, 0);  // the second is 6 cm nearer
  auto estimator = make(0);
  const Ropes found = estimate(estimator, scene.frame());
  ASSERT_EQ(found.ropes.size(), 2U);
  const auto mean_z = [&](std::size_t i) {
    float sum = 0;
    for (const auto& node : found.ropes[i].nodes) sum += node.z;
    return sum / kNodes;
  };
  const int nearer = mean_z(0) < mean_z(1) ? 0 : 1;
  int between = 0;
  for (const RopeCrossing& crossing : found.crossings) {
    if (crossing.over == crossing.under) continue;
    ++between;
    EXPECT_EQ(crossing.over, nearer);
    EXPECT_GT(crossing.over_at_m, 0);
    EXPECT_LT(crossing.over_at_m,
              geometry::length(found.ropes[static_cast<std::size_t>(crossing.over)].nodes));
    EXPECT_NEAR(crossing.apart_m, 0.06, 0.03);
  }
  EXPECT_GE(between, 1);
}

TEST(EstimateRopes, ARingsLastNodeLiesWhereItsFirstDoes) {
  const auto scene = make_ropes(RopesKind::kRings, 2, 0);
  auto estimator = make(0);
  const Ropes found = estimate(estimator, scene.frame());
  ASSERT_EQ(found.ropes.size(), 2U);
  int rings = 0;
  for (const Estimate& rope : found.ropes) {
    if (!rope.closed) continue;
    ++rings;
    EXPECT_EQ(geometry::distance(rope.nodes.front(), rope.nodes.back()), 0);
  }
  EXPECT_EQ(rings, 1);
}

TEST(EstimateRopes, WithLabelsEachIsOneRopeWhateverTheNumber) {
  const auto scene = make_ropes(RopesKind::kGaps, 4, 0);
  auto estimator = make(1);
  const Ropes found = estimate(estimator, scene.frame(true));
  EXPECT_EQ(found.ropes.size(), 4U);
}

TEST(EstimateRopes, OtherRopesAreNoStrandsThatOneLeavesOut) {
  const auto scene = make_ropes(RopesKind::kCrossing, 4, 0);
  auto estimator = make(0);
  const Ropes found = estimate(estimator, scene.frame());
  ASSERT_EQ(found.ropes.size(), 4U);
  for (const Estimate& rope : found.ropes) {
    const auto& doubts = rope.one_rope.doubts;
    EXPECT_EQ(std::count(doubts.begin(), doubts.end(), Doubt::kStrandsLeft), 0);
  }
}

TEST(EstimateRopes, TheNumberOfThreadsChangesNothing) {
  const auto scene = make_ropes(RopesKind::kCrossing, 3, 1);
  auto one = make(0, 1);
  auto four = make(0, 4);
  const Ropes a = estimate(one, scene.frame());
  const Ropes b = estimate(four, scene.frame());
  ASSERT_EQ(a.ropes.size(), b.ropes.size());
  for (std::size_t i = 0; i < a.ropes.size(); ++i) EXPECT_EQ(a.ropes[i].nodes, b.ropes[i].nodes);
  EXPECT_EQ(a.instances, b.instances);
}

TEST(EstimateRopes, ALabelOfAFewPixelsCostsNoOtherRope) {
  auto scene = make_ropes(RopesKind::kCrossing, 2, 0);
  std::size_t spoiled = 0;
  for (std::size_t p = 0, seen = 0; p < scene.image.mask.size() && spoiled < 15; ++p) {
    if (scene.image.mask[p] <= 127 || ++seen % 97 != 0) continue;
    scene.image.instances[p] = 9;
    ++spoiled;
  }
  ASSERT_EQ(spoiled, 15U);
  auto estimator = make(0);
  const Ropes found = estimate(estimator, scene.frame(true));
  EXPECT_EQ(found.ropes.size(), 2U);
  for (const std::uint16_t label : found.instances) EXPECT_LE(label, 2);
}

TEST(EstimateRopes, OneMoreThanThereAreIsNotBelieved) {
  const auto scene = make_ropes(RopesKind::kCrossing, 2, 0);
  auto right = make_with_field(2);
  auto wrong = make_with_field(3);
  for (const Estimate& rope : estimate(right, scene.frame()).ropes) {
    EXPECT_GT(rope.confidence, 0.8F);
  }
  const Ropes found = estimate(wrong, scene.frame());
  ASSERT_EQ(found.ropes.size(), 3U);
  int believed = 0;
  for (const Estimate& rope : found.ropes) believed += rope.confidence > 0.5F ? 1 : 0;
  EXPECT_LE(believed, 1);
}

TEST(EstimateRopes, ABudgetLeavesTheFieldItsWord) {
  const auto scene = make_ropes(RopesKind::kCrossing, 3, 0);
  Config config{.weights = FLOWDLO_WEIGHTS, .device = "cpu"};
  config.field_weights = FLOWDLO_FIELD_WEIGHTS;
  config.threads = 1;
  config.budget_ms = 1;
  config.ropes = 0;
  auto bounded = Estimator::create(config);
  ASSERT_TRUE(bounded) << bounded.error().message;
  auto unbounded = make_with_field(0);
  const Ropes soon = estimate(*bounded, scene.frame());
  const Ropes whole = estimate(unbounded, scene.frame());
  ASSERT_EQ(soon.ropes.size(), whole.ropes.size());
  for (const Estimate& rope : soon.ropes) {
    EXPECT_EQ(std::count(rope.left_out.begin(), rope.left_out.end(), LeftOut::kField), 0);
  }
}

TEST(EstimateRopes, ByHeedOfTheFrameBeforeAClearFrameIsWhatItIsWithout) {
  const auto scene = make_ropes(RopesKind::kCrossing, 3, 0);
  auto estimator = make_with_field(0);
  const Ropes alone = estimate(estimator, scene.frame());
  std::vector<KnownRope> same;
  for (const Estimate& rope : alone.ropes) same.push_back({rope.nodes, rope.closed});
  std::vector<KnownRope> crossed = same;  // ends where no rope has both
  std::swap(crossed[0].nodes.front(), crossed[1].nodes.front());
  std::vector<KnownRope> broken = same;
  broken[0].nodes[7].x = std::numeric_limits<float>::quiet_NaN();
  broken[1].nodes[3].z = -1;
  for (const auto& before : {std::vector<KnownRope>(), same, crossed, broken}) {
    const auto told = estimator.estimate_ropes(scene.frame(), before);
    ASSERT_TRUE(told) << told.error().message;
    ASSERT_EQ(told->ropes.size(), alone.ropes.size());
    for (std::size_t i = 0; i < alone.ropes.size(); ++i) {
      EXPECT_EQ(told->ropes[i].nodes, alone.ropes[i].nodes);
      EXPECT_EQ(told->ropes[i].confidence, alone.ropes[i].confidence);
    }
  }
}

TEST(EstimateRopes, AnOnlyRopeRunsAsItDidInTheFrameBefore) {
  const WaveFrame wave;
  auto estimator = make_with_field(0);
  const Ropes alone = estimate(estimator, wave.frame());
  ASSERT_EQ(alone.ropes.size(), 1U);
  KnownRope before{alone.ropes[0].nodes, false};
  std::reverse(before.nodes.begin(), before.nodes.end());
  const auto told = estimator.estimate_ropes(wave.frame(), {before});
  ASSERT_TRUE(told) << told.error().message;
  ASSERT_EQ(told->ropes.size(), 1U);
  EXPECT_TRUE(told->ropes[0].reversed);
  EXPECT_LT(geometry::distance(told->ropes[0].nodes.front(), before.nodes.front()), 0.01);
}

TEST(EstimateRopes, LabelsThatAreNotThereAndTooManyAreErrors) {
  auto scene = make_ropes(RopesKind::kCrossing, 2, 0);
  auto estimator = make(0);
  std::vector<std::uint16_t> labels(scene.image.mask.size(), 0);
  Frame frame = scene.frame();
  frame.instances = labels;
  const auto none = estimator.estimate_ropes(frame);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("Frame.instances: expected 1 to 32 labels"));
  for (std::size_t p = 0, seen = 0; p < labels.size(); ++p) {
    if (scene.image.mask[p] > 127) labels[p] = static_cast<std::uint16_t>(1 + seen++ % 50);
  }
  const auto many = estimator.estimate_ropes(frame);
  ASSERT_FALSE(many);
  EXPECT_THAT(many.error().message, HasSubstr("got 50"));
  frame.instances = frame.instances.first(10);
  const auto short_ = estimator.estimate_ropes(frame);
  ASSERT_FALSE(short_);
  EXPECT_EQ(short_.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(short_.error().message, HasSubstr("Frame.instances: expected"));
}

TEST(EstimateRopes, ARopeWithoutDepthIsTakenToLieOnTheTable) {
  auto scene = make_ropes(RopesKind::kCrossing, 3, 0);
  auto estimator = make(0);
  hide(2, scene);
  const Ropes found = estimate(estimator, scene.frame(true));
  ASSERT_EQ(found.ropes.size(), 3U);
  std::size_t hidden = 0;
  for (std::size_t p = 0; p < found.instances.size(); ++p) {
    if (scene.image.instances[p] == 2) hidden = found.instances[p];
  }
  for (std::size_t i = 0; i < found.ropes.size(); ++i) {
    const auto& doubts = found.ropes[i].one_rope.doubts;
    EXPECT_EQ(std::count(doubts.begin(), doubts.end(), Doubt::kNoDepth), i + 1 == hidden ? 1 : 0);
  }
}

TEST(EstimateRopes, ARopeOfWhichNothingIsKnownIsLeftOutAndOnlyRopesWithoutAnyAreAFault) {
  auto scene = make_ropes(RopesKind::kCrossing, 3, 0);
  auto estimator = make(0);
  hide(0, scene);
  hide(2, scene);
  const Ropes found = estimate(estimator, scene.frame(true));
  ASSERT_EQ(found.ropes.size(), 2U);
  for (std::size_t p = 0; p < found.instances.size(); ++p) {
    const std::uint16_t rope = scene.image.instances[p];
    ASSERT_EQ(found.instances[p] != 0, rope == 1 || rope == 3);
    ASSERT_LE(found.instances[p], 2);
  }
  hide(1, scene);
  hide(3, scene);
  const auto none = estimator.estimate_ropes(scene.frame(true));
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kNoEvidence);
  EXPECT_THAT(none.error().message, HasSubstr("rope 1 of 3"));
}

TEST(EstimateRopes, AnEstimatorThatWasMovedFromSaysSo) {
  auto estimator = make(0);
  const auto moved = std::move(estimator);
  const WaveFrame wave;
  const auto answer = estimator.estimate_ropes(wave.frame());  // NOLINT(bugprone-use-after-move)
  ASSERT_FALSE(answer);
  EXPECT_THAT(answer.error().message, HasSubstr("moved from"));
}

TEST(EstimateRopes, ALabelledRopeIsReadAsOneThatIsAlone) {
  const auto scene = make_ropes(RopesKind::kCrossing, 2, 1);
  const Frame frame = labelled(scene);
  auto by_field = make_with_field(0);
  const Ropes found = estimate(by_field, frame);
  ASSERT_EQ(found.ropes.size(), 2U);
  const auto parted = estimator::part_ropes(frame, 0);
  ASSERT_TRUE(parted) << parted.error().message;
  for (std::size_t rope = 0; rope < 2; ++rope) {
    const estimator::RopeView view(*parted, rope, frame);
    const auto alone = by_field.estimate(view.frame());
    ASSERT_TRUE(alone) << alone.error().message;
    EXPECT_TRUE(alone->nodes == found.ropes[0].nodes || alone->nodes == found.ropes[1].nodes);
  }
}

TEST(EstimateRopes, SigmaGoesByTheConfidenceThatIsReturned) {
  const auto scene = make_ropes(RopesKind::kCrossing, 3, 2);
  const Frame frame = labelled(scene);
  auto by_field = make_with_field(0);
  const Ropes found = estimate(by_field, frame);
  ASSERT_EQ(found.ropes.size(), 3U);
  for (const Estimate& rope : found.ropes) {
    EXPECT_GT(rope.confidence, 0.9F);
    auto sigma_m = rope.sigma_m;
    std::sort(sigma_m.begin(), sigma_m.end());
    EXPECT_LT(sigma_m[kNodes / 2], 0.006F);
  }
}

TEST(EstimateRopes, TheStrandFieldPartsARingFromARope) {
  auto by_field = make_with_field(0);
  for (const std::uint64_t seed : {0, 1, 2}) {
    const auto scene = make_ropes(RopesKind::kRings, 2, seed);
    const Ropes found = estimate(by_field, scene.frame());
    ASSERT_EQ(found.ropes.size(), 2U) << seed;
    for (const auto& rope : scene.ropes) {
      const auto true_m = static_cast<double>(geometry::length(rope.truth));
      const Estimate& same = found.ropes[found.ropes[0].closed == rope.closed ? 0 : 1];
      EXPECT_EQ(same.closed, rope.closed) << seed;
      EXPECT_NEAR(static_cast<double>(geometry::length(same.nodes)), true_m, 0.1 * true_m) << seed;
    }
  }
}

TEST(OneRopeAmongAnyNumber, IsEstimatedAsOne) {
  auto any = make_with_field(0);
  auto one = make_with_field(1);
  for (const auto kind :
       {lab::Kind::kSimple, lab::Kind::kManyCrossings, lab::Kind::kTouching, lab::Kind::kCoil}) {
    const auto scene = lab::make_scene(kind, 4);
    const Ropes found = estimate(any, scene.frame());
    ASSERT_EQ(found.ropes.size(), 1U) << lab::name_of(kind);
    const auto alone = one.estimate(scene.frame());
    ASSERT_TRUE(alone) << alone.error().message;
    EXPECT_EQ(found.ropes[0].nodes, alone->nodes) << lab::name_of(kind);
    EXPECT_EQ(found.ropes[0].confidence, alone->confidence) << lab::name_of(kind);
    EXPECT_EQ(found.ropes[0].alternatives.size(), alone->alternatives.size()) << lab::name_of(kind);
    for (std::size_t p = 0; p < found.instances.size(); ++p) {
      ASSERT_EQ(found.instances[p], scene.image.mask[p] > 127 ? 1 : 0) << lab::name_of(kind);
    }
  }
}

TEST(OneRopeAmongAnyNumber, IsARingWhereNothingShowsItsEnds) {
  auto any = make_with_field(0);
  for (const std::uint64_t seed : {0, 1, 2}) {
    auto scene = make_ropes(RopesKind::kRings, 2, seed);
    for (std::size_t p = 0; p < scene.image.mask.size(); ++p) {  // what shows of the ring alone
      if (scene.image.instances[p] != 1) scene.image.mask[p] = 0;
    }
    const Ropes found = estimate(any, scene.frame());
    ASSERT_EQ(found.ropes.size(), 1U) << seed;
    EXPECT_TRUE(found.ropes[0].closed) << seed;
  }
}

}  // namespace
}  // namespace flowdlo
