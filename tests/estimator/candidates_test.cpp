#include "estimator/candidates.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "gathered.hpp"
#include "geometry/polyline.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo {
namespace {

class ListCandidates : public ::testing::Test {
 protected:
  /// Draws that repeat the prior, with the model's sigma.
  [[nodiscard]] flow::Prediction draws(int count) const {
    flow::Prediction prediction;
    for (int i = 0; i < count; ++i) {
      prediction.draws.push_back(conditions_.hypotheses.front().prior.nodes);
      prediction.sigma_m.emplace_back().fill(0.02F);
    }
    return prediction;
  }

  [[nodiscard]] std::vector<gate::Candidate> listed(const flow::Prediction& prediction = {},
                                                    const std::vector<DrawReport>& reports = {},
                                                    const std::vector<int>& assigned = {},
                                                    double rope_length_m = 0) const {
    return estimator::list_candidates({1, conditions_.hypotheses}, conditions_.paths.rope_width_px,
                                      prediction, reports, assigned, frame_, rope_length_m);
  }

  testing::WaveFrame wave_;
  Frame frame_ = wave_.frame();
  estimator::Conditions conditions_ = testing::gathered(frame_);
};

TEST_F(ListCandidates, PriorsComeFirstAndDrawsNameTheirHypothesis) {
  conditions_.hypotheses.push_back(conditions_.hypotheses.front());
  conditions_.hypotheses.back().score -= 2;
  const auto candidates = listed(draws(2), {{.accepted = true}, {.accepted = true}}, {0, 1});
  ASSERT_EQ(candidates.size(), 4U);
  EXPECT_EQ(candidates[1].draw, -1);
  EXPECT_DOUBLE_EQ(candidates[1].behind, 2);
  EXPECT_EQ(candidates[2].draw, 0);
  EXPECT_EQ(candidates[2].hypothesis, 0);
  EXPECT_EQ(candidates[3].draw, 1);
  EXPECT_EQ(candidates[3].hypothesis, 1);
  EXPECT_DOUBLE_EQ(candidates[3].behind, 2);
}

TEST_F(ListCandidates, EachSaysWhichReadingsOfTheMaskAgreeWithIt) {
  estimator::SecondLook look{4, {conditions_.hypotheses.front(), conditions_.hypotheses.front()}};
  look.hypotheses[0].votes = 0.25F;
  look.hypotheses[1].votes = 0.75F;
  look.hypotheses[1].odds = 0.6F;
  look.hypotheses[1].reading = 2;
  look.hypotheses[1].score += 1.5;
  const auto candidates =
      estimator::list_candidates(look, conditions_.paths.rope_width_px, {}, {}, {}, frame_, 0);
  ASSERT_EQ(candidates.size(), 2U);
  EXPECT_EQ(candidates[0].readings, 4);
  EXPECT_FALSE(candidates[0].reread);
  EXPECT_EQ(candidates[0].votes, 0.25F);
  EXPECT_TRUE(candidates[1].reread);
  EXPECT_EQ(candidates[1].votes, 0.75F);
  EXPECT_EQ(candidates[1].odds, 0.6F);
  EXPECT_DOUBLE_EQ(candidates[1].behind, -1.5);
}

TEST_F(ListCandidates, ImplausibleDrawsAreNone) {  // Eq. (3.31), (3.32)
  const auto candidates = listed(draws(2), {{.accepted = false}, {.accepted = true}}, {0, 0});
  ASSERT_EQ(candidates.size(), 2U);
  EXPECT_EQ(candidates[1].draw, 1);
}

TEST_F(ListCandidates, EachHasTheSigmaOfWhoeverMadeIt) {
  const auto candidates = listed(draws(1), {{.accepted = true}}, {0});
  EXPECT_EQ(candidates[0].sigma_m, conditions_.hypotheses.front().prior.sigma_m);
  EXPECT_EQ(candidates[1].sigma_m[7], 0.02F);
}

TEST_F(ListCandidates, WithoutAFourthHeadADrawHasItsPriorsSigma) {
  auto prediction = draws(1);
  prediction.sigma_m.clear();
  const auto candidates = listed(prediction, {{.accepted = true}}, {0});
  EXPECT_EQ(candidates[1].sigma_m, candidates[0].sigma_m);
}

TEST_F(ListCandidates, LengthCountsOnlyWhereItIsKnown) {
  const auto length_m =
      static_cast<double>(geometry::length(conditions_.hypotheses.front().prior.nodes));
  const auto off = [&](double known_m) { return listed({}, {}, {}, known_m)[0].length_off; };
  EXPECT_EQ(off(0), 0);
  EXPECT_NEAR(off(length_m), 0, 1e-5);
  EXPECT_NEAR(off(2 * length_m), std::log(2.0), 1e-4);
}

TEST_F(ListCandidates, UnseenIsHowFarTheNearestNodeWithSupportIsAlongTheRope) {
  auto& support = conditions_.hypotheses.front().prior.support;
  support.fill(1);
  support[20] = support[21] = support[22] = 0;
  const auto candidates = listed();
  const auto segments_m = geometry::segment_lengths(candidates[0].nodes);
  EXPECT_EQ(candidates[0].unseen_m[19], 0);
  EXPECT_NEAR(candidates[0].unseen_m[20], segments_m[19], 1e-6);
  EXPECT_NEAR(candidates[0].unseen_m[21], segments_m[19] + segments_m[20], 1e-5);
  EXPECT_NEAR(candidates[0].unseen_m[22], segments_m[22], 1e-6);
}

TEST_F(ListCandidates, WithoutAnySupportTheWholeRopeIsUnseen) {
  conditions_.hypotheses.front().prior.support.fill(0);
  const auto candidates = listed();
  EXPECT_NEAR(candidates[0].unseen_m[30], geometry::length(candidates[0].nodes), 1e-4);
}

TEST_F(ListCandidates, AGoodPriorLooksGood) {
  const auto candidates = listed();
  ASSERT_EQ(candidates.size(), conditions_.hypotheses.size());
  EXPECT_GT(candidates[0].radius_m, 0);
  EXPECT_GT(candidates[0].tube.mask_recall, 0.95F);
  EXPECT_GT(candidates[0].supported, 0.9F);
}

}  // namespace
}  // namespace flowdlo
