#include "strand/measure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "mat/mat_image.hpp"
#include "straight.hpp"
#include "strand/targets.hpp"

namespace flowdlo::strand {
namespace {

constexpr float kFocal_px = 500;

field::Channels shown(const Targets& targets) {
  return field::Channels(image::Image<const std::array<float, field::kChannels>>(
      mat::image_of<std::array<float, field::kChannels>>(targets.field)));
}

cv::Mat mask_of(const std::vector<Strand>& strands, const cv::Size& size) {
  cv::Mat mask = cv::Mat::zeros(size, CV_32F);
  for (const Strand& strand : strands) {
    for (const AxisPoint& point : strand.points) {
      cv::circle(mask, {static_cast<int>(point.u), static_cast<int>(point.v)}, 4, cv::Scalar(1),
                 -1);
    }
  }
  return mask;
}

TEST(Measure, APerfectFieldFindsAllAndNothingElse) {
  std::vector<Strand> strands{straight(10, 30, 110, 30, 0), straight(10, 39, 110, 39, 1)};
  for (Strand& strand : strands) strand.begins = strand.ends = true;
  const Targets targets = targets_of(strands, kFocal_px, {120, 70});
  const Counts counts = measure(strands, mask_of(strands, {120, 70}), field::ridges(shown(targets)),
                                field::tips(shown(targets)));
  EXPECT_GT(counts.places, 200);
  EXPECT_EQ(counts.found, counts.places);
  EXPECT_EQ(counts.merged_places, counts.places) << "they lie a width apart";
  EXPECT_EQ(counts.right, counts.shown);
  EXPECT_EQ(counts.ends, 4);
  EXPECT_EQ(counts.ends_found, 4);
  EXPECT_EQ(counts.tips_right, counts.tips);
}

TEST(Measure, TipsAndEndsAreCountedByHowClearlyTheyShow) {
  std::vector<Strand> strands{straight(10, 30, 110, 30, 0), straight(30, 50, 90, 50, 1)};
  for (Strand& strand : strands) strand.begins = strand.ends = true;
  strands[1].ends = false;  // the field will show a tip there that is none
  std::vector<Strand> shows = strands;
  shows[1].ends = true;
  shows[0].ends = false;  // and will not show one that is
  auto field = shown(targets_of(shows, kFocal_px, {120, 70}));
  for (int v = 0; v < field.height(); ++v) {
    for (int u = 60; u < field.width(); ++u) field.at(v, u)[field::kTip] *= 0.6F;
  }
  const TipLevels levels = tip_levels(strands, field, 0.3F);
  ASSERT_EQ(levels.tips.size(), 3U);
  int right = 0;
  for (const auto& tip : levels.tips) {
    right += tip.right;
    EXPECT_EQ(tip.right, tip.level > 0.7F) << "only the wrong one lies in the fainter half";
  }
  EXPECT_EQ(right, 2);
  ASSERT_EQ(levels.ends.size(), 3U);
  EXPECT_EQ(std::count(levels.ends.begin(), levels.ends.end(), 0.0F), 1);
  EXPECT_EQ(tip_levels(strands, field, 0.7F).tips.size(), 2U);
}

TEST(Measure, ThinningOfAMergedMaskFindsNeitherStrand) {
  const std::vector<Strand> strands{straight(10, 30, 110, 30, 0), straight(10, 38, 110, 38, 1)};
  const cv::Mat mask = mask_of(strands, {120, 70});
  const Counts counts = measure(strands, mask, thinned(mask), {});
  EXPECT_LT(counts.found, counts.places / 5);
  EXPECT_LT(counts.merged_right, counts.merged_shown / 2);
}

TEST(Measure, ThinningOfOneStrandFindsIt) {
  const std::vector<Strand> strands{straight(10, 30, 110, 50, 0)};
  const cv::Mat mask = mask_of(strands, {120, 70});
  const Counts counts = measure(strands, mask, thinned(mask), {});
  EXPECT_GT(counts.found, 0.9 * static_cast<double>(counts.places));
  EXPECT_EQ(counts.merged_places, 0);
}

TEST(Measure, WrongDirectionsFindNothing) {
  const std::vector<Strand> strands{straight(10, 30, 110, 30, 0)};
  auto ridge = field::ridges(shown(targets_of(strands, kFocal_px, {120, 70})));
  for (auto& point : ridge) point.angle += 0.5F;
  const Counts counts = measure(strands, mask_of(strands, {120, 70}), ridge, {});
  EXPECT_EQ(counts.found, 0);
  EXPECT_EQ(counts.right, counts.shown) << "they lie where they should";
}

TEST(Measure, CrossingsAreRightWhereTheFieldRunsAsTheUpperStrand) {
  Strand below = straight(60, 5, 60, 65, 1, 0.5F);
  for (AxisPoint& point : below.points) {
    if (std::abs(point.v - 35) < 4) point.seen = Seen::kUnder;
  }
  const std::vector<Strand> strands{straight(10, 35, 110, 35, 0, 0.49F), below};
  const Targets targets = targets_of(strands, kFocal_px, {120, 70});
  Counts right;
  measure_crossings(strands, targets.field, right);
  EXPECT_EQ(right.crossings, 1);
  EXPECT_EQ(right.crossings_right, 1);

  Strand above = below;  // the field of a scene where the other one is on top
  for (AxisPoint& point : above.points) point.seen = Seen::kYes;
  const Targets other = targets_of({above}, kFocal_px, {120, 70});
  Counts wrong;
  measure_crossings(strands, other.field, wrong);
  EXPECT_EQ(wrong.crossings, 1);
  EXPECT_EQ(wrong.crossings_right, 0);
}

}  // namespace
}  // namespace flowdlo::strand
