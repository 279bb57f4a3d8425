// Several ropes of one frame, from end to end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>

#include "estimator/parted.hpp"
#include "estimator/rope_crossings.hpp"
#include "estimator/rope_readings.hpp"
#include "estimator/rope_views.hpp"
#include "estimator/second_look.hpp"
#include "estimator/see_axes.hpp"
#include "field/network.hpp"
#include "flowdlo/estimator.hpp"
#include "geometry/polyline.hpp"
#include "path/strand_reading.hpp"
#include "reference/program.hpp"
#include "scene/ropes.hpp"
#include "scene/scene.hpp"
#include "support/wave_frame.hpp"
#include "weights/field_weights.hpp"

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

TEST(EstimateRopes, ARingsLastNodeLiesNextToItsFirst) {
  const auto scene = make_ropes(RopesKind::kRings, 2, 0);
  auto estimator = make(0);
  const Ropes found = estimate(estimator, scene.frame());
  ASSERT_EQ(found.ropes.size(), 2U);
  int rings = 0;
  for (const Estimate& rope : found.ropes) {
    if (!rope.closed) continue;
    ++rings;
    const double length = static_cast<double>(geometry::length(rope.nodes));
    EXPECT_LT(geometry::distance(rope.nodes.front(), rope.nodes.back()), 2 * length / (kNodes - 1));
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

TEST(RopeViews, AnUpperRopesPixelsAreThereInTheLowerOnesViewWithoutDepth) {
  const auto scene = make_ropes(RopesKind::kHanging, 2, 0);
  const auto parted = estimator::part_ropes(scene.frame(), 2);
  ASSERT_TRUE(parted) << parted.error().message;
  std::size_t shared = 0;
  for (std::size_t rope = 0; rope < 2; ++rope) {
    const estimator::RopeView view(*parted, rope, scene.frame());
    const Frame frame = view.frame();
    for (std::size_t p = 0; p < frame.mask.size(); ++p) {
      const bool own = parted->instances[p] == rope + 1;
      if (own) {
        ASSERT_GT(frame.mask[p], 127);
        ASSERT_EQ(frame.depth_m[p], scene.image.depth_m[p]);
      } else if (frame.mask[p] > 127) {
        ++shared;
        ASSERT_EQ(frame.depth_m[p], 0);
      }
    }
  }
  EXPECT_GT(shared, 10U);
}

TEST(RopeCrossings, LinesThatCrossBackWithinTwoWidthsDoNotCross) {
  std::vector<Estimate> ropes(2);
  for (std::size_t i = 0; i < kNodes; ++i) {
    const float x = -0.2F + 0.4F * static_cast<float>(i) / (kNodes - 1);
    ropes[0].nodes[i] = {x, 0, 0.5F};
    const bool other_side = i == 31;  // one node strays over the other rope
    ropes[1].nodes[i] = {x, other_side ? -0.001F : 0.004F, 0.51F};
  }
  std::vector<std::uint8_t> mask(640 * 480, 0);
  std::fill_n(mask.begin(), 6400, std::uint8_t{255});
  const Frame frame{640, 480, {600, 600, 320, 240}, {}, mask, {}};
  EXPECT_TRUE(estimator::rope_crossings(ropes, frame).empty());
  for (std::size_t i = 32; i < kNodes; ++i) ropes[1].nodes[i].y = -0.004F;
  const auto crossings = estimator::rope_crossings(ropes, frame);
  ASSERT_EQ(crossings.size(), 1U);
  EXPECT_EQ(crossings[0].over, 0);
  EXPECT_EQ(crossings[0].under, 1);
  EXPECT_NEAR(crossings[0].over_at_m, 0.2F, 0.02F);
}

TEST(RopeCrossings, OfARingAreThoseThatShow) {
  std::vector<Estimate> ropes(2);
  ropes[0].closed = true;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const float turn = 6.2831853F * static_cast<float>(i) / kNodes;
    ropes[0].nodes[i] = {0.1F * std::cos(turn), 0.1F * std::sin(turn), 0.5F};
    const float along = -0.2F + 0.4F * static_cast<float>(i) / (kNodes - 1);
    ropes[1].nodes[i] = {along, along / 90, 0.45F};  // once through the gap of the last node
  }
  std::vector<std::uint8_t> mask(640 * 480, 0);
  std::fill_n(mask.begin(), 6400, std::uint8_t{255});
  const Frame frame{640, 480, {600, 600, 320, 240}, {}, mask, {}};
  const auto crossings = estimator::rope_crossings(ropes, frame);
  ASSERT_EQ(crossings.size(), 2U);
  for (const RopeCrossing& crossing : crossings) EXPECT_EQ(crossing.over, 1);
}

// A path along a straight line.
path::Path line(const Eigen::Vector2f& from, const Eigen::Vector2f& to) {
  path::Path path;
  for (int i = 0; i <= 100; ++i) {
    path.points_px.emplace_back(from + (to - from) * static_cast<float>(i) / 100);
  }
  path.bridged.assign(path.points_px.size(), 0);
  return path;
}

TEST(RopeReadings, OneRopeIsTheSameInEitherDirectionAndNoneThatEndsElsewhere) {
  const path::Path rope = line({10, 10}, {200, 40});
  EXPECT_TRUE(estimator::same_rope(rope, line({12, 14}, {198, 37}), 8));
  EXPECT_TRUE(estimator::same_rope(rope, line({200, 40}, {10, 10}), 8));
  EXPECT_FALSE(estimator::same_rope(rope, line({10, 10}, {150, 32}), 8));
  EXPECT_FALSE(estimator::same_rope(rope, line({10, 30}, {200, 60}), 8));
  path::Path ring = line({10, 10}, {200, 40});
  ring.closed = true;
  EXPECT_FALSE(estimator::same_rope(rope, ring, 8));
  path::Path turned = ring;
  std::rotate(turned.points_px.begin(), turned.points_px.begin() + 30, turned.points_px.end());
  EXPECT_TRUE(estimator::same_rope(ring, turned, 8));
}

TEST(RopeReadings, WithoutAFieldTheMasksRopesHaveNoWitness) {
  const auto scene = make_ropes(RopesKind::kCrossing, 2, 0);
  const auto blind = [](float) { return std::optional<field::Axes>(); };
  for (const estimator::SeeAxes& see : {estimator::SeeAxes(), estimator::SeeAxes(blind)}) {
    const auto read = estimator::read_ropes(scene.frame(), 0, see);
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read->paths.ropes.size(), 2U);
    EXPECT_THAT(read->witness, ::testing::Each(estimator::Witness::kNone));
  }
}

/// The axes of what the mask's reading has.
field::Axes axes_of(const path::RopePaths& ropes) {
  field::Axes axes;
  axes.width_px = ropes.rope_width_px;
  axes.magnified_for_px = axes.width_px;
  for (const path::Path& rope : ropes.ropes) axes.lines.push_back({rope.points_px, {1, 1}});
  return axes;
}

TEST(RopeReadings, TheAxesRopesAreTakenAndTheMasksSayWhichTheyKnow) {
  const auto scene = make_ropes(RopesKind::kCrossing, 2, 0);
  const auto masked = path::trace_ropes(scene.frame(), 0);
  ASSERT_TRUE(masked) << masked.error().message;
  field::Axes axes = axes_of(*masked);  // of one of the two ropes whole, of the other one a half
  auto& half = axes.lines.back().points_px;
  half.resize(half.size() / 2);
  std::vector<float> asked_px;
  const auto read = estimator::read_ropes(scene.frame(), 0, [&](float width_px) {
    asked_px.push_back(width_px);
    return std::optional(axes);
  });
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(asked_px.size(), 2U) << "what the mask does not know is looked at more closely";
  EXPECT_EQ(asked_px[0], masked->rope_width_px);
  EXPECT_FLOAT_EQ(asked_px[1], estimator::kCloser * axes.width_px);
  EXPECT_THAT(read->witness, ::testing::UnorderedElementsAre(estimator::Witness::kAgrees,
                                                             estimator::Witness::kDiffers));
}

TEST(RopeReadings, RopesThatAreToldApartSurelyAreLookedAtOnce) {
  const auto scene = make_ropes(RopesKind::kCrossing, 2, 0);
  const auto masked = path::trace_ropes(scene.frame(), 0);
  ASSERT_TRUE(masked) << masked.error().message;
  int asked = 0;
  const auto read = estimator::read_ropes(scene.frame(), 0, [&](float) {
    ++asked;
    return std::optional(axes_of(*masked));
  });
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(asked, 1);
  EXPECT_THAT(read->witness, ::testing::Each(estimator::Witness::kAgrees));
}

/// Where there is no time for it, or it fails.
TEST(RopeReadings, WithoutACloserLookTheFirstOneStands) {
  const auto scene = make_ropes(RopesKind::kCrossing, 2, 0);
  const auto masked = path::trace_ropes(scene.frame(), 0);
  ASSERT_TRUE(masked) << masked.error().message;
  field::Axes axes = axes_of(*masked);
  auto& half = axes.lines.back().points_px;
  half.resize(half.size() / 2);
  int asked = 0;
  const auto once = [&](float) {
    return asked++ == 0 ? std::optional(axes) : std::optional<field::Axes>();
  };
  const auto read = estimator::read_ropes(scene.frame(), 0, once);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(asked, 2);
  const auto first = path::trace_ropes(scene.frame(), axes, 0, masked->guesses);
  ASSERT_TRUE(first);
  ASSERT_EQ(read->paths.ropes.size(), first->ropes.size());
  for (std::size_t i = 0; i < first->ropes.size(); ++i) {
    EXPECT_EQ(read->paths.ropes[i].points_px, first->ropes[i].points_px);
  }
}

TEST(RopeReadings, WhereTheFieldCannotLookCloserItIsAskedOnce) {
  const auto scene = make_ropes(RopesKind::kCrossing, 2, 0);
  const auto masked = path::trace_ropes(scene.frame(), 0);
  ASSERT_TRUE(masked) << masked.error().message;
  auto axes = axes_of(*masked);
  axes.lines.pop_back();  // the other rope is in doubt
  axes.magnified_for_px = estimator::kCloser * axes.width_px;
  int asked = 0;
  const auto read = estimator::read_ropes(scene.frame(), 0, [&](float) {
    ++asked;
    return std::optional(axes);
  });
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(asked, 1);
}

TEST(RopeReadings, WhereTheAxesMakeNoRopesTheMasksAreInDoubt) {
  const auto scene = make_ropes(RopesKind::kCrossing, 2, 0);
  const auto read = estimator::read_ropes(scene.frame(), 0, [](float) {
    return std::optional(field::Axes{{}, 8});
  });
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->paths.ropes.size(), 2U);
  EXPECT_THAT(read->witness, ::testing::Each(estimator::Witness::kDiffers));
}

TEST(RopeReadings, OfNoiseTheFieldIsNotAsked) {
  const auto scene = make_ropes(RopesKind::kCrossing, 2, 0);
  Frame frame = scene.frame();
  std::vector<std::uint8_t> mask(frame.mask.size(), 0);
  std::uint32_t state = 1;
  for (std::uint8_t& at : mask) {
    state = 1664525U * state + 1013904223U;
    at = (state >> 24U) < 77U ? 255 : 0;  // three pixels in ten
  }
  frame.mask = mask;
  int asked = 0;
  const auto read = estimator::read_ropes(frame, 0, [&](float) {
    ++asked;
    return std::optional<field::Axes>();
  });
  EXPECT_EQ(asked, 0);
  if (!read) return;  // nor need it be ropes
  EXPECT_TRUE(read->paths.filtered);
  const auto parted = estimator::part_ropes(frame, 0, {});
  ASSERT_TRUE(parted) << parted.error().message;
  EXPECT_TRUE(estimator::RopeView(*parted, 0, frame).traced().paths.filtered);
}

TEST(RopeViews, TakeAlongWhatTheFieldShows) {
  auto weights = weights::load_field(FLOWDLO_FIELD_WEIGHTS);
  ASSERT_TRUE(weights) << weights.error().message;
  auto network =
      field::Network::create(std::make_shared<const weights::FieldWeights>(*std::move(weights)),
                             [] { return reference::create_program(1); });
  ASSERT_TRUE(network);
  const auto scene = make_ropes(RopesKind::kCrossing, 2, 0);
  const Frame frame = scene.frame();
  const auto parted = estimator::part_ropes(frame, 0, estimator::seen_by(&*network, frame));
  ASSERT_TRUE(parted) << parted.error().message;
  ASSERT_EQ(parted->paths.ropes.size(), 2U);
  for (std::size_t rope = 0; rope < 2; ++rope) {
    const auto traced = estimator::RopeView(*parted, rope, frame).traced();
    ASSERT_TRUE(traced.seen);
    const auto& points = traced.paths.ranked.front().points_px;
    const std::size_t place = points.size() / 10;
    const Eigen::Vector2f along = (points[place + 2] - points[place]).normalized();
    EXPECT_GT(traced.seen->shown(points[place + 1], along).any(), 0.4F);
  }
  const auto masked = estimator::part_ropes(frame, 0);
  ASSERT_TRUE(masked);
  EXPECT_FALSE(estimator::RopeView(*masked, 0, frame).traced().seen) << "none was asked";
}

TEST(EstimateRopes, ALabelledRopeIsReadAsOneThatIsAlone) {
  const auto scene = make_ropes(RopesKind::kCrossing, 2, 1);
  Frame frame = scene.frame();
  frame.instances = scene.image.instances;
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
  Frame frame = scene.frame();
  frame.instances = scene.image.instances;
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
