#include "path/strand_reading.hpp"

#include <gtest/gtest.h>

#include "canvas.hpp"
#include "support/painted_field.hpp"

namespace flowdlo::path {
namespace {

using testing::Axis;
using testing::painted_field;
using testing::show_tip;
using testing::straight_axis;

/// A rope of 8 px in a frame of 320 x 240, seen one to one, whose mask is as `axes` drawn `mask_px`
/// wide.
struct Seen {
  test::Canvas canvas{320, 240};
  field::StrandField field;

  explicit Seen(const std::vector<Axis>& axes, int mask_px = 9) {
    for (const Axis& axis : axes) {
      test::Curve curve;
      for (const Eigen::Vector2f& p : axis) {
        curve.emplace_back(static_cast<int>(std::lround(p.x())),
                           static_cast<int>(std::lround(p.y())));
      }
      canvas.stroke(curve, mask_px).depth(curve, mask_px, 0.5F);
    }
    field.region = {{0, 0, 320, 240}, {320, 240}, {1, 1}};
    field.channels = painted_field(axes, {320, 240});
  }
  [[nodiscard]] Result<Traversals> traced() const {
    return trace_strands(canvas.frame(), field::axes(field));
  }
};

/// Two legs 8 px apart, one after the other, and the bend that joins them.
Axis hairpin() {
  Axis axis = straight_axis({40, 100}, {240, 100});
  const Axis bend = testing::arc_axis({240, 120}, 20, -1.57F, 1.57F);
  axis.insert(axis.end(), bend.begin(), bend.end());
  const Axis back = straight_axis({240, 140}, {200, 109});
  axis.insert(axis.end(), back.begin(), back.end());
  const Axis beside = straight_axis({200, 109}, {60, 108});
  axis.insert(axis.end(), beside.begin(), beside.end());
  return axis;
}

TEST(StrandReading, FollowsBothLegsOfAHairpinThatTheMaskMerges) {
  const Axis axis = hairpin();
  Seen seen({axis}, 12);
  show_tip(seen.field.channels, axis.front());
  show_tip(seen.field.channels, axis.back());
  const auto traced = seen.traced();
  ASSERT_TRUE(traced) << traced.error().message;
  const Path& best = traced->ranked.front();
  EXPECT_NEAR(static_cast<float>(best.points_px.size()), 0.5F * static_cast<float>(axis.size()),
              25);
  EXPECT_NEAR(traced->rope_width_px, 8, 0.5F);
  const Eigen::Vector2f ends[2] = {best.points_px.front(), best.points_px.back()};
  const auto reaches = [&](const Eigen::Vector2f& tip) {
    return std::min((ends[0] - tip).norm(), (ends[1] - tip).norm()) < 6;
  };
  EXPECT_TRUE(reaches(axis.front()));
  EXPECT_TRUE(reaches(axis.back()));
}

TEST(StrandReading, GoesStraightOnBelowAStrandThatCrosses) {
  // A loop: out along a line, round, and back across it on top.
  Axis axis = straight_axis({30, 150}, {200, 150});
  const Axis round = testing::arc_axis({200, 100}, 50, 1.57F, -3.14F);
  axis.insert(axis.end(), round.begin(), round.end());
  const Axis down = straight_axis({150, 100}, {150, 220});
  Seen seen({axis, down});
  show_tip(seen.field.channels, axis.front());
  show_tip(seen.field.channels, down.back());
  const auto traced = seen.traced();
  ASSERT_TRUE(traced) << traced.error().message;
  const Path& best = traced->ranked.front();
  EXPECT_NEAR(static_cast<float>(best.points_px.size()), 170 + 235 + 120, 30);
  const bool forwards = (best.points_px.front() - axis.front()).norm() < 8;
  const auto& first = forwards ? best.points_px.front() : best.points_px.back();
  const auto& last = forwards ? best.points_px.back() : best.points_px.front();
  EXPECT_LT((first - axis.front()).norm(), 8);
  EXPECT_LT((last - down.back()).norm(), 8);
}

TEST(StrandReading, WhatIsNoMaskIsNoRope) {
  Seen seen({straight_axis({30, 60}, {280, 60})});
  const Seen other({straight_axis({30, 60}, {280, 60}), straight_axis({30, 180}, {280, 180})});
  seen.field.channels = other.field.channels;  // a cable that nobody asked for
  const auto traced = seen.traced();
  ASSERT_TRUE(traced) << traced.error().message;
  for (const Eigen::Vector2f& p : traced->ranked.front().points_px) EXPECT_NEAR(p.y(), 60, 6);
}

TEST(StrandReading, WithoutAnyStrandTheMasksLongAxisIsLeft) {
  Seen seen({straight_axis({30, 60}, {280, 60})});
  seen.field.channels.setTo(0);
  const auto traced = seen.traced();
  ASSERT_TRUE(traced) << traced.error().message;
  EXPECT_GT(traced->ranked.front().points_px.size(), 200U);
}

TEST(StrandReading, AnEmptyMaskHasNoPath) {
  Seen seen({straight_axis({30, 60}, {280, 60})});
  seen.canvas.mask.setTo(0);
  const auto traced = seen.traced();
  ASSERT_FALSE(traced);
  EXPECT_EQ(traced.error().code, ErrorCode::kNoPath);
}

}  // namespace
}  // namespace flowdlo::path
