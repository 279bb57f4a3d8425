#include "path/links.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "field/channel.hpp"
#include "path/strand_reading.hpp"
#include "seen.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;
using testing::Axis;
using testing::show_tip;
using testing::straight_axis;

/// Two ropes that cross at (160, 120), the upright one on top.
struct Crossing : test::Seen {
  Crossing() : Seen({straight_axis({40, 120}, {280, 120}), straight_axis({160, 30}, {160, 210})}) {}

  /// What runs below `from` to `to` there, in the direction of the cosine and sine of twice its
  /// angle.
  void show_below(const cv::Point& from, const cv::Point& to, float cosine, float sine) {
    for (int v = from.y; v <= to.y; ++v) {
      for (int u = from.x; u <= to.x; ++u) {
        auto& at = field.channels.at(v, u);
        at[field::kUnder] = 1;
        at[field::kUnderCos] = cosine;
        at[field::kUnderSin] = sine;
      }
    }
  }
};

/// What links are made of, of `axes` or those that the field shows.
class Linked {
 public:
  explicit Linked(const test::Seen& seen) : Linked(seen, field::axes(seen.field)) {}
  Linked(const test::Seen& seen, field::Axes axes)
      : frame_(seen.canvas.frame()),
        axes_(std::move(axes)),
        region_(cleaned(frame_)),
        strands_(strands_of(frame_, axes_, region_)),
        cover_(region_, frame_, strands_.width_px, strands_.seen) {}
  Linked(const Linked&) = delete;
  Linked& operator=(const Linked&) = delete;

  [[nodiscard]] const Strands& strands() const { return strands_; }
  [[nodiscard]] std::vector<std::vector<Bond>> links() const {
    return prices_of(strands_, region_, frame_).bonds;
  }
  [[nodiscard]] Link between(int from, int to,
                             float most = std::numeric_limits<float>::max()) const {
    return link_between(from, to, strands_, cover_, kOneRopeLinks, most);
  }

 private:
  static Region cleaned(const Frame& frame) {
    auto region = clean(frame);
    if (!region) throw std::runtime_error(region.error().message);
    return *std::move(region);
  }

  Frame frame_;
  field::Axes axes_;
  Region region_;
  Strands strands_;
  Cover cover_;
};

/// The terms of the link over a gap in a level rope, from u = `left` to `right`.
LinkTerms across(const test::Seen& seen, float left, float right) {
  field::Axes axes;
  axes.width_px = 8;
  axes.view = field::FieldView(seen.field);
  axes.lines.push_back({straight_axis({40, 120}, {left, 120}), {1, 0}});
  axes.lines.push_back({straight_axis({right, 120}, {280, 120}), {0, 1}});
  return Linked(seen, std::move(axes)).between(1, 2).terms;
}

TEST(Links, WhatTheFieldShowsBelowIsNotHeldAgainstALink) {
  Crossing crossing;
  const LinkTerms unshown = across(crossing, 152, 168);
  crossing.show_below({150, 116}, {170, 124}, 1, 0);
  const LinkTerms shown = across(crossing, 152, 168);
  EXPECT_GT(unshown[kLinkUnshown], shown[kLinkUnshown] + 0.1F);
  EXPECT_LT(shown[kLinkUnshown], 0.1F);
  EXPECT_LT(energy_of(shown, kOneRopeLinks), energy_of(unshown, kOneRopeLinks));
  EXPECT_LT(shown[kLinkBend], 0.5F) << "it goes straight on";
  EXPECT_LT(shown[kLinkOpen], 0.01F);
}

TEST(Links, WhatRunsBelowAnotherWayIsNoHelp) {
  Crossing crossing;
  crossing.show_below({150, 116}, {170, 124}, -1, 0);
  EXPECT_GT(across(crossing, 152, 168)[kLinkUnshown], 0.1F);
}

TEST(Links, OverBareBackgroundCosts) {
  Crossing crossing;
  const cv::Rect bare(90, 90, 24, 60);
  crossing.canvas.mask(bare).setTo(0);
  cv::Mat depth_m(crossing.canvas.mask.size(), CV_32F, crossing.canvas.depth_m.data());
  depth_m(bare).setTo(0.8F);
  crossing.field.channels.fill({});
  EXPECT_GT(across(crossing, 89, 114)[kLinkOpen], 0.9F);
}

TEST(Links, ALinkThatWouldCostTooMuchIsNoneAndTheLimitChangesNoOther) {
  const Crossing crossing;
  const Linked linked(crossing);
  for (int to = 2; to < static_cast<int>(2 * linked.strands().list.size()); ++to) {
    const Link free = linked.between(0, to);
    EXPECT_EQ(linked.between(0, to, free.energy + 0.01F).energy, free.energy);
    EXPECT_EQ(linked.between(0, to, 0.5F * free.energy).energy, 0.5F * free.energy);
  }
}

TEST(Links, AnEndThatShowsAndTheImagesBorderAreTheCheapStops) {
  StrandEnd bare;
  StrandEnd tip;
  tip.tip_seen = 1;
  StrandEnd border;
  border.leaves = true;
  const auto cost = [](const StrandEnd& end) { return energy_of(stop_terms(end), kStopWeights); };
  EXPECT_EQ(cost(tip), cost(border));
  EXPECT_LT(cost(border), cost(bare) - 1);
}

TEST(Links, AreSortedAndLeadNowhereTwice) {
  const Crossing crossing;
  const Linked linked(crossing);
  const auto links = linked.links();
  ASSERT_EQ(links.size(), 2 * linked.strands().list.size());
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
  const Axis out = straight_axis({20, 90}, {200, 174});
  const Axis round = testing::arc_axis({216, 139.5F}, 38, 2.0071F, -2.0071F);
  const Axis back = straight_axis(round.back(), {20, 189});
  Axis rope = out;
  rope.insert(rope.end(), round.begin(), round.end());
  rope.insert(rope.end(), back.begin(), back.end());
  test::Seen seen({rope});
  show_tip(seen.field.channels, rope.front());
  show_tip(seen.field.channels, rope.back());
  const auto traced = seen.traced();
  ASSERT_TRUE(traced) << traced.error().message;
  const auto& points = traced->ranked.front().points_px;
  const bool forwards =
      (points.front() - rope.front()).norm() < (points.back() - rope.front()).norm();
  EXPECT_LT(((forwards ? points.front() : points.back()) - rope.front()).norm(), 10);
  EXPECT_LT(((forwards ? points.back() : points.front()) - rope.back()).norm(), 10);
  EXPECT_NEAR(static_cast<float>(points.size()), 0.5F * static_cast<float>(rope.size()), 40);
}

}  // namespace
}  // namespace flowdlo::path
