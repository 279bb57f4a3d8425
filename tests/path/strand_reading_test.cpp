#include "path/strand_reading.hpp"

#include <gtest/gtest.h>

#include "geometry/mask_box.hpp"
#include "path/links.hpp"
#include "path/strands.hpp"
#include "path/window.hpp"
#include "seen.hpp"
#include "support/peak_memory.hpp"

namespace flowdlo::path {
namespace {

using test::Seen;
using testing::Axis;
using testing::show_tip;
using testing::straight_axis;

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
  seen.field.channels.fill({});
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

bool joins(const Path& path, const Eigen::Vector2f& a, const Eigen::Vector2f& b) {
  const Eigen::Vector2f& first = path.points_px.front();
  const Eigen::Vector2f& last = path.points_px.back();
  return std::min(std::max((first - a).norm(), (last - b).norm()),
                  std::max((first - b).norm(), (last - a).norm())) < 8;
}

TEST(StrandReading, RopesSideBySideInOneMaskAreTwo) {
  const Axis one = straight_axis({40, 100}, {260, 100});
  const Axis two = straight_axis({60, 108}, {280, 108});
  Seen seen({one, two}, 12);
  for (const Axis* axis : {&one, &two}) {
    show_tip(seen.field.channels, axis->front());
    show_tip(seen.field.channels, axis->back());
  }
  const auto merged = trace_ropes(seen.canvas.frame(), 0);
  const auto traced = trace_ropes(seen.canvas.frame(), field::axes(seen.field), 0);
  ASSERT_TRUE(traced) << traced.error().message;
  ASSERT_EQ(traced->ropes.size(), 2U);
  const bool first = joins(traced->ropes[0], one.front(), one.back());
  EXPECT_TRUE(joins(traced->ropes[first ? 0 : 1], one.front(), one.back()));
  EXPECT_TRUE(joins(traced->ropes[first ? 1 : 0], two.front(), two.back()));
  ASSERT_TRUE(merged) << merged.error().message;
  EXPECT_FALSE(merged->ropes.size() == 2 && joins(merged->ropes[0], one.front(), one.back()) &&
               joins(merged->ropes[1], two.front(), two.back()))
      << "the mask alone is enough";
}

TEST(StrandReading, LinesThatChangedOverWhereARopeCrossesItselfAreJoinedAnew) {
  // A loop: on to the right, round, and back down across itself at 45 degrees.
  const Eigen::Vector2f crossing(79.3F, 160);
  const Axis along = straight_axis({20, 160}, {200, 160});
  const Axis round = testing::arc_axis({200, 110}, 50, 1.5708F, -2.3562F);
  const Axis back = straight_axis(round.back(), {40, 199.3F});
  Axis rope = along;
  rope.insert(rope.end(), round.begin(), round.end());
  rope.insert(rope.end(), back.begin(), back.end());
  const Seen seen({rope});
  // Seen as one line that takes the loop the wrong way round, and another one for what is left.
  Axis wrong = straight_axis({20, 160}, crossing + Eigen::Vector2f(-5, 0));
  const Axis over = straight_axis(crossing + Eigen::Vector2f(6, -6), round.back());
  wrong.insert(wrong.end(), over.begin(), over.end());
  wrong.insert(wrong.end(), round.rbegin(), round.rend());
  const Axis to_crossing = straight_axis({200, 160}, crossing + Eigen::Vector2f(5, 0));
  wrong.insert(wrong.end(), to_crossing.begin(), to_crossing.end());
  field::Axes axes;
  axes.width_px = 8;
  axes.lines.push_back({wrong, {1, 0}});
  axes.lines.push_back({straight_axis(crossing + Eigen::Vector2f(-4, 4), back.back()), {0, 1}});
  const auto traced = trace_ropes(seen.canvas.frame(), axes, 0);
  ASSERT_TRUE(traced) << traced.error().message;
  ASSERT_EQ(traced->ropes.size(), 1U);
  const auto& points = traced->ropes.front().points_px;
  EXPECT_TRUE(joins(traced->ropes.front(), rope.front(), rope.back()));
  const bool forwards = (points.front() - rope.front()).norm() < 8;
  const auto third = points[forwards ? points.size() / 3 : points.size() - points.size() / 3];
  EXPECT_GT(third.y(), 130) << "the loop is entered along its lower side";
}

/// A rope 60 px wide through a frame too large to be traced as it is, and its axis.
struct LargeFrame {
  static constexpr float kWidth_px = 60;
  test::Canvas canvas{3600, 3000};
  field::Axes axes;

  LargeFrame() {
    const test::Curve corners = {{100, 150}, {3500, 150}, {3500, 2850}, {300, 2850}};
    canvas.stroke(corners, static_cast<int>(kWidth_px));
    field::AxisLine line;
    line.tips[0] = line.tips[1] = 1;
    for (std::size_t i = 1; i < corners.size(); ++i) {
      const auto place = [](const cv::Point& p) {
        return Eigen::Vector2f(static_cast<float>(p.x), static_cast<float>(p.y));
      };
      const Axis side = straight_axis(place(corners[i - 1]), place(corners[i]));
      line.points_px.insert(line.points_px.end(), side.begin(), side.end());
    }
    axes.lines.push_back(line);
    axes.width_px = kWidth_px;
  }
};

TEST(StrandReading, OfALargeMaskIsTheFramesAgain) {
  const LargeFrame large;
  ASSERT_GT(reduction_of(large.canvas.frame(), geometry::mask_box(large.canvas.frame())), 1);
  const auto traced = trace_strands(large.canvas.frame(), large.axes);
  ASSERT_TRUE(traced) << traced.error().message;
  EXPECT_NEAR(traced->rope_width_px, LargeFrame::kWidth_px, 4);
  const Path& best = traced->ranked.front();
  EXPECT_TRUE(joins(best, {100, 150}, {300, 2850}));
  EXPECT_NEAR(static_cast<float>(best.points_px.size()), 3400 + 2700 + 3200, 200);
  const auto ropes = trace_ropes(large.canvas.frame(), large.axes, 0);
  ASSERT_TRUE(ropes) << ropes.error().message;
  ASSERT_EQ(ropes->ropes.size(), 1U);
  EXPECT_TRUE(joins(ropes->ropes.front(), {100, 150}, {300, 2850}));
}

TEST(StrandReading, OfALargeMaskTakesNoMoreMemoryThanItsReductionDoes) {
  if (test::kSanitized) GTEST_SKIP() << "memory is not ours alone";
  const LargeFrame large;
  const Frame frame = large.canvas.frame();
  const double megapixels = static_cast<double>(frame.width) * frame.height / 1e6;
  constexpr double kBytesPerPixel = 8;  // 5 of them copies of depth and mask as they are
  EXPECT_LT(test::peak_growth_mb([&] { (void)trace_strands(frame, large.axes); }),
            kBytesPerPixel * megapixels);
}

}  // namespace
}  // namespace flowdlo::path
