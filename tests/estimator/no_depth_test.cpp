// A rope that shows no depth is taken to lie on what is seen beside it, and the estimate says so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "flowdlo/estimator.hpp"
#include "geometry/polyline.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Not;

constexpr float kRope_px = 9;
constexpr float kTable_m = 0.5F;
constexpr float kRadius_m = 0.5F * kRope_px / (0.95F * 320) * kTable_m;

/// A wave on a table; whether the rope has a depth, `shown` says.
testing::WaveFrame wave_on_table(bool shown) {
  testing::WaveFrame wave(320, 240, kRope_px);
  for (std::size_t i = 0; i < wave.depth_m.size(); ++i) {
    if (wave.mask[i] == 0) wave.depth_m[i] = kTable_m;
    if (wave.mask[i] != 0) wave.depth_m[i] = shown ? kTable_m - 1.9F * kRadius_m : 0;
  }
  return wave;
}

Estimator make(FieldChoice field) {
  return *Estimator::create({.weights = FLOWDLO_DEFAULT_WEIGHTS,
                             .device = "cpu",
                             .quality = Quality::kFast,
                             .field = field,
                             .threads = 1});
}

class NoDepth : public ::testing::TestWithParam<FieldChoice> {};

TEST_P(NoDepth, OfARopeOnATableIsTakenFromTheTable) {
  auto estimator = make(GetParam());
  const auto shown = estimator.estimate(wave_on_table(true).frame());
  const auto hidden = estimator.estimate(wave_on_table(false).frame());
  ASSERT_TRUE(shown) << shown.error().message;
  ASSERT_TRUE(hidden) << hidden.error().message;
  EXPECT_THAT(shown->one_rope.doubts, Not(Contains(Doubt::kNoDepth)));
  EXPECT_THAT(hidden->one_rope.doubts, ElementsAre(Doubt::kNoDepth));
  // The networks that move nodes beside a field know an axis of which nothing is measured to a
  // radius.
  const float most_radii = GetParam() == FieldChoice::kOff ? 0.6F : 1.0F;
  EXPECT_LT(geometry::mean_distance(hidden->nodes, shown->nodes), most_radii * kRadius_m);
  EXPECT_LE(hidden->confidence, 0.25F);
  EXPECT_GT(shown->confidence, 0.25F);
  EXPECT_THAT(hidden->support, Each(0));
}

INSTANTIATE_TEST_SUITE_P(With, NoDepth, ::testing::Values(FieldChoice::kBeside, FieldChoice::kOff),
                         [](const auto& field) {
                           return field.param == FieldChoice::kOff ? "TheMaskAlone" : "AField";
                         });

TEST(NoDepthAnywhere, IsAnError) {
  auto estimator = make(FieldChoice::kBeside);
  testing::WaveFrame wave = wave_on_table(false);
  std::fill(wave.depth_m.begin(), wave.depth_m.end(), 0.0F);
  const auto estimate = estimator.estimate(wave.frame());
  ASSERT_FALSE(estimate);
  EXPECT_EQ(estimate.error().code, ErrorCode::kNoEvidence);
}

}  // namespace
}  // namespace flowdlo
