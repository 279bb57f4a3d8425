#include "path/links.hpp"

#include <gtest/gtest.h>

#include "canvas.hpp"
#include "field/channel.hpp"
#include "path/strand_reading.hpp"
#include "path/walk_costs.hpp"
#include "support/painted_field.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;
using testing::Axis;
using testing::painted_field;
using testing::show_tip;
using testing::straight_axis;

/// Two ropes of 8 px that cross at (160, 120) in a frame of 320 x 240, the upright one on top: the
/// level one shows as two lines.
struct Crossing {
  test::Canvas canvas{320, 240};
  field::StrandField field;
  Axis level = straight_axis({40, 120}, {280, 120});
  Axis upright = straight_axis({160, 30}, {160, 210});

  Crossing() {
    canvas.stroke({{40, 120}, {280, 120}}, 9).depth({{40, 120}, {280, 120}}, 9, 0.51F);
    canvas.stroke({{160, 30}, {160, 210}}, 9).depth({{160, 30}, {160, 210}}, 9, 0.5F);
    field.region = {{0, 0, 320, 240}, {320, 240}, {1, 1}};
    field.channels = painted_field({level, upright}, {320, 240});
  }

  /// What runs below `from` to `to` there, in the direction of the cosine and sine of twice its
  /// angle.
  void show_below(const cv::Point& from, const cv::Point& to, float cosine, float sine) {
    for (int v = from.y; v <= to.y; ++v) {
      for (int u = from.x; u <= to.x; ++u) {
        float* const at = field.channels.ptr<float>(v) + u * field::kChannels;
        at[field::kUnder] = 1;
        at[field::kUnderCos] = cosine;
        at[field::kUnderSin] = sine;
      }
    }
  }
};

/// The terms of the link from the left line's right end to the right line's left end.
LinkTerms across(const Crossing& crossing) {
  const Frame frame = crossing.canvas.frame();
  const auto region = clean(frame);
  if (!region) throw std::runtime_error(region.error().message);
  field::Axes axes;
  axes.width_px = 8;
  axes.view = field::FieldView(crossing.field);
  axes.lines.push_back({straight_axis({40, 120}, {152, 120}), {1, 0}});
  axes.lines.push_back({straight_axis({168, 120}, {280, 120}), {0, 1}});
  const Strands strands = strands_of(frame, axes, *region);
  const Cover cover(*region, frame, strands.width_px, strands.seen);
  return link_between(1, 2, strands, cover).terms;
}

TEST(Links, WhatTheFieldShowsBelowIsNotHeldAgainstALink) {
  Crossing crossing;
  const LinkTerms unshown = across(crossing);
  crossing.show_below({150, 116}, {170, 124}, 1, 0);
  const LinkTerms shown = across(crossing);
  EXPECT_GT(unshown[kLinkUnshown], shown[kLinkUnshown] + 0.1F);
  EXPECT_LT(shown[kLinkUnshown], 0.1F);
  EXPECT_LT(energy_of(shown, kLinkWeights), energy_of(unshown, kLinkWeights));
  EXPECT_LT(shown[kLinkBend], 0.5F) << "it goes straight on";
  EXPECT_LT(shown[kLinkOpen], 0.01F);
}

TEST(Links, WhatRunsBelowAnotherWayIsNoHelp) {
  Crossing crossing;
  crossing.show_below({150, 116}, {170, 124}, -1, 0);
  EXPECT_GT(across(crossing)[kLinkUnshown], 0.1F);
}

TEST(Links, OverBareBackgroundCosts) {
  Crossing crossing;
  const cv::Rect bare(90, 90, 24, 60);
  crossing.canvas.mask(bare).setTo(0);
  cv::Mat depth_m(crossing.canvas.mask.size(), CV_32F, crossing.canvas.depth_m.data());
  depth_m(bare).setTo(0.8F);
  crossing.field.channels.setTo(0);
  field::Axes axes;
  axes.width_px = 8;
  axes.view = field::FieldView(crossing.field);
  axes.lines.push_back({straight_axis({40, 120}, {89, 120}), {1, 0}});
  axes.lines.push_back({straight_axis({114, 120}, {280, 120}), {0, 1}});
  const Frame frame = crossing.canvas.frame();
  const auto region = clean(frame);
  ASSERT_TRUE(region);
  const Strands strands = strands_of(frame, axes, *region);
  const Cover cover(*region, frame, strands.width_px, strands.seen);
  EXPECT_GT(link_between(1, 2, strands, cover).terms[kLinkOpen], 0.9F);
}

TEST(Links, ALinkThatWouldCostTooMuchIsNoneAndTheLimitChangesNoOther) {
  const Crossing crossing;
  const Frame frame = crossing.canvas.frame();
  const auto region = clean(frame);
  ASSERT_TRUE(region);
  const field::Axes axes = field::axes(crossing.field);
  const Strands strands = strands_of(frame, axes, *region);
  const Cover cover(*region, frame, strands.width_px, strands.seen);
  for (int to = 2; to < static_cast<int>(2 * strands.list.size()); ++to) {
    const Link free = link_between(0, to, strands, cover);
    EXPECT_EQ(link_between(0, to, strands, cover, free.energy + 0.01F).energy, free.energy);
    EXPECT_EQ(link_between(0, to, strands, cover, 0.5F * free.energy).energy, 0.5F * free.energy);
  }
}

TEST(Links, AnEndThatShowsAndTheImagesBorderAreCheaperStops) {
  StrandEnd bare;
  StrandEnd tip;
  tip.tip_seen = 1;
  StrandEnd border;
  border.leaves = true;
  const auto cost = [](const StrandEnd& end) { return energy_of(stop_terms(end), kStopWeights); };
  EXPECT_LT(cost(tip), cost(border));
  EXPECT_LT(cost(border), cost(bare));
}

TEST(Links, AreSortedAndLeadNowhereTwice) {
  const Crossing crossing;
  const Frame frame = crossing.canvas.frame();
  const auto region = clean(frame);
  ASSERT_TRUE(region);
  const field::Axes axes = field::axes(crossing.field);
  const Strands strands = strands_of(frame, axes, *region);
  const auto links = make_links(strands, *region, frame);
  ASSERT_EQ(links.size(), 2 * strands.list.size());
  for (std::size_t end = 0; end < links.size(); ++end) {
    for (std::size_t i = 0; i < links[end].size(); ++i) {
      EXPECT_NE(static_cast<std::size_t>(links[end][i].to) / 2, end / 2);
      if (i == 0) continue;
      EXPECT_LE(links[end][i - 1].cost, links[end][i].cost);
      EXPECT_NE(links[end][i - 1].to, links[end][i].to);
    }
  }
}

TEST(Links, ARopeThatCrossesItselfFlatlyIsFollowedThroughTheCrossing) {
  // A long loop whose legs cross at 25 degrees; as seen, one line changes from leg to leg there.
  Crossing crossing;
  crossing.canvas.mask.setTo(0);
  const Axis out = straight_axis({20, 90}, {200, 174});
  const Axis round = testing::arc_axis({216, 139.5F}, 38, 2.0071F, -2.0071F);
  const Axis back = straight_axis(round.back(), {20, 189});
  Axis rope = out;
  rope.insert(rope.end(), round.begin(), round.end());
  rope.insert(rope.end(), back.begin(), back.end());
  test::Curve curve;
  for (const Vector2f& p : rope) {
    curve.emplace_back(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
  }
  crossing.canvas.stroke(curve, 9).depth(curve, 9, 0.5F);
  crossing.field.channels = painted_field({rope}, {320, 240});
  show_tip(crossing.field.channels, rope.front());
  show_tip(crossing.field.channels, rope.back());
  const auto traced = trace_strands(crossing.canvas.frame(), field::axes(crossing.field));
  ASSERT_TRUE(traced) << traced.error().message;
  const auto& points = traced->ranked.front().points_px;
  const bool forwards = (points.front() - rope.front()).norm() < (points.back() - rope.front()).norm();
  EXPECT_LT(((forwards ? points.front() : points.back()) - rope.front()).norm(), 10);
  EXPECT_LT(((forwards ? points.back() : points.front()) - rope.back()).norm(), 10);
  EXPECT_NEAR(static_cast<float>(points.size()), 0.5F * static_cast<float>(rope.size()), 40);
}

}  // namespace
}  // namespace flowdlo::path
