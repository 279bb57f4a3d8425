#include "strand/targets.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "field/channel.hpp"
#include "straight.hpp"

namespace flowdlo::strand {
namespace {

constexpr float kFocal_px = 500;
const cv::Size kSize(64, 64);

float at(const Targets& targets, int u, int v, field::Channel channel) {
  return targets.field.ptr<float>(v)[u * field::kChannels + channel];
}

/// Two strands that cross in the middle; the level one lies on top, a width nearer.
std::vector<Strand> crossing() {
  Strand below = straight(32, 2, 32, 62, 1, 0.5F);
  for (AxisPoint& point : below.points) {
    if (std::abs(point.v - 32) < 4) point.seen = Seen::kUnder;
  }
  return {straight(2, 32, 62, 32, 0, 0.492F), below};
}

TEST(Targets, AStrandIsBrightestOnItsAxis) {
  const Targets targets = targets_of({straight(2, 32, 62, 32)}, kFocal_px, kSize);
  EXPECT_NEAR(at(targets, 30, 32, field::kCentre), 1, 0.02F);
  EXPECT_NEAR(at(targets, 30, 34, field::kCentre), std::exp(-1.0F), 0.03F);  // a quarter width off
  EXPECT_EQ(at(targets, 30, 50, field::kCentre), 0);
  EXPECT_EQ(at(targets, 30, 35, field::kRope), 1);
  EXPECT_EQ(at(targets, 30, 37, field::kRope), 0);
  EXPECT_NEAR(at(targets, 30, 32, field::kWidth), 0, 1e-4F);  // eight pixels
}

TEST(Targets, DirectionIsALinesWhicheverWayTheStrandRuns) {
  for (const bool back : {false, true}) {
    const auto strand = back ? straight(60, 60, 4, 4) : straight(4, 4, 60, 60);
    const Targets targets = targets_of({strand}, kFocal_px, kSize);
    EXPECT_NEAR(at(targets, 32, 32, field::kCos), 0, 1e-3F);  // twice 45 degrees
    EXPECT_NEAR(at(targets, 32, 32, field::kSin), 1, 1e-3F);
  }
}

TEST(Targets, TheUpperStrandShowsAndTheOtherLiesUnderIt) {
  const Targets targets = targets_of(crossing(), kFocal_px, kSize);
  EXPECT_NEAR(at(targets, 32, 32, field::kCos), 1, 1e-3F);  // level
  EXPECT_NEAR(at(targets, 32, 32, field::kUnder), 1, 0.02F);
  EXPECT_NEAR(at(targets, 32, 32, field::kUnderCos), -1, 1e-3F);  // upright
  EXPECT_EQ(at(targets, 15, 32, field::kUnder), 0);
  EXPECT_NEAR(at(targets, 32, 20, field::kCos), -1, 1e-3F) << "beside it the lower one shows";
}

TEST(Targets, AnEdgeIsWhereTheUpperStrandEndsBeforeTheLower) {
  const Targets targets = targets_of(crossing(), kFocal_px, kSize);
  EXPECT_EQ(at(targets, 32, 35, field::kEdge), 1);
  EXPECT_EQ(at(targets, 32, 32, field::kEdge), 0);
  EXPECT_EQ(at(targets, 15, 35, field::kEdge), 0);
}

TEST(Targets, OnlyEndsThatShowAreTips) {
  Strand strand = straight(12, 32, 50, 32);
  strand.begins = strand.ends = true;
  for (std::size_t i = strand.points.size() - 20; i < strand.points.size(); ++i) {
    strand.points[i].seen = Seen::kNo;
  }
  const Targets targets = targets_of({strand}, kFocal_px, kSize);
  EXPECT_NEAR(at(targets, 12, 32, field::kTip), 1, 1e-3F);
  EXPECT_EQ(at(targets, 50, 32, field::kTip), 0);
  EXPECT_EQ(visible_tips({strand}).size(), 1U);
}

TEST(Targets, WhatAThingHidesIsNoStrand) {
  Strand strand = straight(2, 32, 62, 32);
  for (AxisPoint& point : strand.points) {
    if (point.u > 30 && point.u < 45) point.seen = Seen::kNo;
  }
  const Targets targets = targets_of({strand}, kFocal_px, kSize);
  EXPECT_EQ(at(targets, 37, 32, field::kCentre), 0);
  EXPECT_GT(at(targets, 20, 32, field::kCentre), 0.9F);
}

TEST(Targets, PlacesAlongTheRopeAndBesideItsAxisAreKnown) {
  const Targets targets = targets_of({straight(2, 32, 62, 32)}, kFocal_px, kSize);
  EXPECT_NEAR(targets.along.at<float>(32, 34), 4, 0.1F);
  EXPECT_NEAR(targets.off.at<float>(34, 34), 0.5F, 0.05F);
  EXPECT_NEAR(targets.off.at<float>(30, 34), -0.5F, 0.05F);
  EXPECT_GT(targets.off.at<float>(50, 34), 8);
}

}  // namespace
}  // namespace flowdlo::strand
