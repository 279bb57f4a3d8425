#include "field/view.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "support/painted_field.hpp"

namespace flowdlo::field {
namespace {

using Eigen::Vector2f;
using testing::painted_field;
using testing::show_tip;
using testing::straight_axis;

/// A rope from left to right along v = 60, its end at u = 140, and one that passes below it along
/// u = 80; magnified twice from a frame in which its region begins at (10, 20).
StrandField seen() {
  StrandField field;
  field.region = {{10, 20, 80, 60}, {160, 120}, {2, 2}};
  field.channels = painted_field({straight_axis({20, 60}, {140, 60})}, {160, 120});
  show_tip(field.channels, {140, 60});
  for (int v = 56; v <= 64; ++v) {
    for (int u = 78; u <= 82; ++u) {
      auto& at = field.channels.at(v, u);
      at[kUnder] = 1;
      at[kUnderCos] = -1;
      at[kUnderSin] = 0;
    }
  }
  return field;
}

TEST(FieldView, TakesThePixelsForRopeThatItShowsAsRope) {
  const FieldView view(seen());
  constexpr int kWidth = 100;
  constexpr int kHeight = 90;
  const auto mask = view.rope_mask(kWidth, kHeight);
  ASSERT_EQ(mask.size(), static_cast<std::size_t>(kWidth) * kHeight);
  int rope = 0;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const bool is = view.at({static_cast<float>(u), static_cast<float>(v)}, kRope) > 0.5F;
      ASSERT_EQ(mask[static_cast<std::size_t>(v) * kWidth + static_cast<std::size_t>(u)],
                is ? 255 : 0)
          << u << ", " << v;
      rope += is ? 1 : 0;
    }
  }
  EXPECT_NEAR(rope, 60 * 4, 40) << "of a rope 60 px long and 4 px wide in the frame";
  EXPECT_EQ(FieldView().rope_mask(3, 2), std::vector<std::uint8_t>(6, 0));
}

TEST(FieldView, AStrandShowsAlongItselfAndNotAcross) {
  const StrandField field = seen();
  const FieldView view(field);
  const Vector2f on_it = field.region.to_frame({50, 60});
  EXPECT_GT(view.shown(on_it, {1, 0}).any(), 0.9F);
  EXPECT_GT(view.shown(on_it, {-1, 0}).any(), 0.9F);
  EXPECT_LT(view.shown(on_it, {0, 1}).any(), 0.01F);
  EXPECT_LT(view.shown(on_it, {1, 0}).below, 0.01F) << "it lies on top";
}

TEST(FieldView, WhatLiesBelowShowsAlongItself) {
  const StrandField field = seen();
  const FieldView view(field);
  const Vector2f crossing = field.region.to_frame({80, 60});
  EXPECT_GT(view.shown(crossing, {0, 1}).below, 0.9F);
  EXPECT_LT(view.shown(crossing, {1, 0}).below, 0.01F);
  EXPECT_GT(view.shown(crossing, {1, 0}).any(), 0.9F);
}

TEST(FieldView, NothingShowsFarFromAnyStrandOrWithoutAField) {
  const StrandField field = seen();
  EXPECT_LT(FieldView(field).shown(field.region.to_frame({50, 100}), {1, 0}).any(), 0.01F);
  EXPECT_EQ(FieldView(field).shown({-500, 900}, {1, 0}).any(), 0);
  EXPECT_EQ(FieldView().shown({10, 10}, {1, 0}).any(), 0);
  EXPECT_EQ(FieldView().tip_ahead({10, 10}, {1, 0}), 0);
}

TEST(FieldView, ATipShowsAheadOfALineThatEndsBeforeIt) {
  const StrandField field = seen();
  const FieldView view(field);
  const Vector2f before = field.region.to_frame({134, 60});
  EXPECT_GT(view.tip_ahead(before, {1, 0}), 0.9F);
  EXPECT_LT(view.tip_ahead(field.region.to_frame({120, 60}), {-1, 0}), 0.1F);
}

TEST(FieldView, FromACopyOfTheFrameItShowsTheSame) {
  const StrandField field = seen();
  const FieldView view(field);
  constexpr float kScale = 0.25F;
  const Vector2f origin(-3.5F, 1.25F);
  const FieldView copy = view.from_copy(origin, kScale);
  for (const Vector2f& at : {Vector2f(50, 60), Vector2f(80, 61), Vector2f(138, 58)}) {
    const Vector2f p = field.region.to_frame(at);
    const Vector2f q = kScale * p + origin;
    const auto copied = copy.shown(q, {0.8F, 0.6F});
    const auto shown = view.shown(p, {0.8F, 0.6F});
    EXPECT_NEAR(copied.top, shown.top, 1e-3F);
    EXPECT_NEAR(copied.below, shown.below, 1e-3F);
    EXPECT_NEAR(copy.tip_ahead(q, {1, 0}), view.tip_ahead(p, {1, 0}), 1e-3F);
  }
}

}  // namespace
}  // namespace flowdlo::field
