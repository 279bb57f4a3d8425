#include "estimator/rope_readings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "estimator/parted.hpp"
#include "estimator/rope_views.hpp"
#include "estimator/second_look.hpp"
#include "path/strand_reading.hpp"
#include "scene/ropes.hpp"

namespace flowdlo {
namespace {

using lab::make_ropes;
using lab::RopesKind;

TEST(RopeReadings, WithoutAFieldTheMasksRopesHaveNoWitness) {
  const auto scene = make_ropes(RopesKind::kCrossing, 2, 0);
  const auto blind = [](const Frame&, float) { return std::optional<field::Axes>(); };
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
  const auto read = estimator::read_ropes(scene.frame(), 0, [&](const Frame&, float width_px) {
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
  const auto read = estimator::read_ropes(scene.frame(), 0, [&](const Frame&, float) {
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
  const auto once = [&](const Frame&, float) {
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
  const auto read = estimator::read_ropes(scene.frame(), 0, [&](const Frame&, float) {
    ++asked;
    return std::optional(axes);
  });
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(asked, 1);
}

TEST(RopeReadings, WhereTheAxesMakeNoRopesTheMasksAreInDoubt) {
  const auto scene = make_ropes(RopesKind::kCrossing, 2, 0);
  const auto read = estimator::read_ropes(scene.frame(), 0, [](const Frame&, float) {
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
  const auto read = estimator::read_ropes(frame, 0, [&](const Frame&, float) {
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

}  // namespace
}  // namespace flowdlo
