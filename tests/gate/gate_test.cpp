// Sec. 3.6: plausibility check and fallback.
#include "gate/gate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace flowdlo::gate {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Seen by a camera with f = 1: pixels are metres at depth 1. All of the 128 x 8 image is mask, but
/// for the columns from `masked_columns` on.
class Scene {
 public:
  explicit Scene(int masked_columns = 128) : pixels_(std::size_t{128} * 8, 0) {
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      pixels_[i] = static_cast<int>(i % 128) < masked_columns ? 255 : 0;
    }
  }

  [[nodiscard]] Verdict choose(const std::vector<Centerline>& predictions,
                               const Centerline& prior) const {
    const std::vector<Centerline> priors(predictions.size(), prior);
    return choose(predictions, priors, prior);
  }

  [[nodiscard]] Verdict choose(const std::vector<Centerline>& predictions,
                               const std::vector<Centerline>& priors,
                               const Centerline& fallback) const {
    const Limits limits{.mask_dilation_px = 0};
    const DilatedMask mask({128, 8, kCamera, {}, pixels_, {}}, limits);
    return gate::choose(predictions, priors, fallback, mask, kCamera, limits);
  }

 private:
  static constexpr Intrinsics kCamera{1, 1, 0, 0};
  std::vector<std::uint8_t> pixels_;
};

/// Nodes `spacing` px apart along a row, from `start`.
Centerline row_of_nodes(float spacing, float start = 0) {
  Centerline nodes{};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i] = {start + static_cast<float>(i) * spacing, 2, 1};
  }
  return nodes;
}

/// 62 segments of `spacing` and one, in the middle, of `longest`.
Centerline row_with_one_long_segment(float spacing, float longest) {
  Centerline nodes = row_of_nodes(spacing);
  for (std::size_t i = 32; i < nodes.size(); ++i) nodes[i].x += longest - spacing;
  return nodes;
}

// L = 63 * 0.5 and 63 * 1, d = 0.5: ratio 1/2, share 1/63.
TEST(Choose, ReportsTheLengthsOfEquation3_30AsTheRatiosOfEquation3_31) {
  const Verdict verdict = Scene().choose({row_of_nodes(0.5F)}, row_of_nodes(1));
  ASSERT_EQ(verdict.draws.size(), 1U);
  EXPECT_EQ(verdict.draws[0].length_ratio, 0.5F);
  EXPECT_FLOAT_EQ(verdict.draws[0].max_segment_share, 1.0F / 63);
  EXPECT_EQ(verdict.draws[0].mask_agreement, 1);
  EXPECT_TRUE(verdict.draws[0].finite);
}

TEST(Choose, AcceptsLengthRatiosFromOneHalfToTwoInclusive) {  // Eq. (3.31)
  const Centerline prior = row_of_nodes(1);
  const Verdict verdict = Scene().choose(
      {row_of_nodes(0.49F), row_of_nodes(0.5F), row_of_nodes(2), row_of_nodes(2.01F)}, prior);
  EXPECT_FALSE(verdict.draws[0].accepted);
  EXPECT_TRUE(verdict.draws[1].accepted);
  EXPECT_TRUE(verdict.draws[2].accepted);
  EXPECT_FALSE(verdict.draws[3].accepted);
}

// 62 segments of 9/16 px and one of 62/16: share 62 / (558 + 62) = 0.1; of 63/16: 63 / 621.
TEST(Choose, AcceptsASegmentShareOfOneTenthButNoMore) {  // Eq. (3.31)
  const Verdict verdict = Scene().choose({row_with_one_long_segment(9.0F / 16, 62.0F / 16),
                                          row_with_one_long_segment(9.0F / 16, 63.0F / 16)},
                                         row_of_nodes(1));
  EXPECT_TRUE(verdict.draws[0].accepted);
  EXPECT_FLOAT_EQ(verdict.draws[0].max_segment_share, 0.1F);
  EXPECT_FALSE(verdict.draws[1].accepted);
  EXPECT_FLOAT_EQ(verdict.draws[1].max_segment_share, 63.0F / 621);
}

// The mask's columns are 0..63 and the prior's samples u = 0..63: all hit. Shifted by 3 px 61 of 64
// hit, 0.953 >= 0.95; by 4 px 60 of 64, 0.9375.
TEST(Choose, AllowsTheMaskAgreementToFallByOneTwentiethBelowThePriors) {  // Eq. (3.32)
  const Verdict verdict =
      Scene(64).choose({row_of_nodes(1, 4), row_of_nodes(1, 3)}, row_of_nodes(1));
  EXPECT_EQ(verdict.prior_agreement, 1);
  EXPECT_EQ(verdict.draws[0].mask_agreement, 60.0F / 64);
  EXPECT_FALSE(verdict.draws[0].accepted);
  EXPECT_EQ(verdict.draws[1].mask_agreement, 61.0F / 64);
  EXPECT_TRUE(verdict.draws[1].accepted);
  EXPECT_EQ(verdict.draw, 1);
}

TEST(Choose, ReturnsTheAcceptedDrawOfHighestMaskAgreement) {  // Eq. (3.33), spec section 5
  const Verdict verdict = Scene(64).choose(
      {row_of_nodes(1, 3), row_of_nodes(1, 1), row_of_nodes(1, 2)}, row_of_nodes(1, 3));
  EXPECT_EQ(verdict.source, Source::kPrediction);
  EXPECT_EQ(verdict.draw, 1);
}

TEST(Choose, BreaksTiesToTheLowerIndex) {  // spec section 5
  const Verdict verdict = Scene(64).choose(
      {row_of_nodes(1, 3), row_of_nodes(1, 1), row_of_nodes(1, 1)}, row_of_nodes(1));
  EXPECT_EQ(verdict.draw, 1);
}

TEST(Choose, DoesNotReturnARejectedDrawHoweverWellItAgrees) {  // Eq. (3.33)
  const Verdict verdict =
      Scene(64).choose({row_of_nodes(0.25F), row_of_nodes(1, 2)}, row_of_nodes(1));
  EXPECT_GT(verdict.draws[0].mask_agreement, verdict.draws[1].mask_agreement);
  EXPECT_EQ(verdict.draw, 1);
}

TEST(Choose, FallsBackToThePriorWhenNoDrawIsAccepted) {  // Eq. (3.33)
  const Verdict verdict = Scene().choose({row_of_nodes(0.1F), row_of_nodes(0.2F)}, row_of_nodes(1));
  EXPECT_EQ(verdict.source, Source::kPrior);
  EXPECT_EQ(verdict.draw, -1);
  EXPECT_EQ(verdict.draws.size(), 2U);
}

TEST(Choose, FallsBackToThePriorWithoutAnyDraw) {
  const Verdict verdict = Scene().choose({}, row_of_nodes(1));
  EXPECT_EQ(verdict.source, Source::kPrior);
  EXPECT_EQ(verdict.draw, -1);
  EXPECT_EQ(verdict.prior_agreement, 1);
}

TEST(Choose, JudgesEachDrawAgainstItsOwnPrior) {
  const Verdict verdict = Scene().choose({row_of_nodes(0.25F), row_of_nodes(0.25F)},
                                         {row_of_nodes(1), row_of_nodes(0.25F)}, row_of_nodes(1));
  EXPECT_FALSE(verdict.draws[0].accepted);
  EXPECT_EQ(verdict.draws[0].length_ratio, 0.25F);
  EXPECT_TRUE(verdict.draws[1].accepted);
  EXPECT_EQ(verdict.draws[1].length_ratio, 1);
}

TEST(Choose, RejectsADrawThatIsNotFinite) {  // Eq. (3.31)
  for (const float bad : {kNan, kInfinity, -kInfinity}) {
    Centerline prediction = row_of_nodes(1);
    prediction[40].z = bad;
    const Verdict verdict = Scene().choose({prediction}, row_of_nodes(1));
    EXPECT_EQ(verdict.source, Source::kPrior);
    EXPECT_FALSE(verdict.draws[0].finite);
    EXPECT_EQ(verdict.draws[0].length_ratio, 0);
    EXPECT_EQ(verdict.draws[0].mask_agreement, 0);
  }
}

TEST(Choose, RejectsEveryDrawOfAPriorThatIsNotFinite) {  // Eq. (3.31), (3.32)
  Centerline prior = row_of_nodes(1);
  prior[0].x = kNan;
  const Verdict verdict = Scene().choose({row_of_nodes(1)}, prior);
  EXPECT_FALSE(verdict.draws[0].accepted);
  EXPECT_TRUE(verdict.draws[0].finite);
  EXPECT_EQ(verdict.prior_agreement, 0);
}

TEST(Choose, RejectsCollapsedAndOverflowingCurvesWithFiniteFigures) {  // Eq. (3.31)
  Centerline overflowing = row_of_nodes(1);
  for (std::size_t i = 0; i < overflowing.size(); ++i) {
    overflowing[i].x = i % 2 == 0 ? 3e38F : -3e38F;
  }
  const Centerline collapsed = row_of_nodes(0);
  for (const Centerline& prior : {row_of_nodes(1), row_of_nodes(1e-30F), collapsed}) {
    const Verdict verdict = Scene().choose({overflowing, collapsed}, prior);
    for (const DrawReport& report : verdict.draws) {
      EXPECT_FALSE(report.accepted);
      EXPECT_TRUE(std::isfinite(report.length_ratio));
      EXPECT_TRUE(std::isfinite(report.max_segment_share));
      EXPECT_TRUE(std::isfinite(report.mask_agreement));
    }
  }
}

TEST(Choose, AcceptsThePriorItself) {
  const Centerline prior = row_of_nodes(1, 40);
  EXPECT_EQ(Scene(64).choose({prior}, prior).draw, 0);
}

}  // namespace
}  // namespace flowdlo::gate
