#include "eval/draws.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "eval/scenes.hpp"

namespace flowdlo::eval {
namespace {

using testing::SizeIs;

void append(const Centerline& nodes, std::vector<float>& values) {
  for (const Point3& node : nodes) values.insert(values.end(), {node.x, node.y, node.z});
}

struct Judged {
  Estimate estimate;
  Tensors tensors;
};

// Two draws, 1 and 3 cm off, of which the gate takes the second; the prior is 2 cm off.
Judged judged() {
  Judged result;
  result.tensors.draws = 2;
  append(test::wave(0.01), result.tensors.prediction);
  append(test::wave(0.03), result.tensors.prediction);
  append(test::wave(0.02), result.tensors.prior);
  result.estimate.draws.resize(2);
  result.estimate.draws[1].accepted = true;
  result.estimate.draws[0].mask_agreement = 0.5F;
  result.estimate.draws[1].mask_agreement = 1;
  return result;
}

TEST(Draws, HybridPutsThePriorInThePlaceOfARejectedDraw) {  // Sec. 4.4.4
  const auto [estimate, tensors] = judged();
  Trial trial;
  add_draw_scores(estimate, tensors, test::wave(0), "", trial);
  EXPECT_NEAR(trial.of("model")->index_m, 0.02, 1e-5);
  EXPECT_NEAR(trial.of("hybrid")->index_m, 0.025, 1e-5);
  EXPECT_NEAR(trial.of("oracle")->index_m, 0.01, 1e-5);
}

TEST(Draws, AccountsHoldAcceptanceAndMaskConsistency) {
  const auto [estimate, tensors] = judged();
  Trial trial;
  add_draws(estimate, tensors, "full", trial);
  EXPECT_EQ(trial.account("full")->accepted, 1);
  EXPECT_NEAR(trial.account("full")->mask_agreement, 0.75, 1e-6);
  EXPECT_THAT(trial.curves.at("full"), SizeIs(2));
  EXPECT_NE(trial.account("full.prior"), nullptr);
}

TEST(Draws, SweptModelsKeepNoCurves) {
  const auto [estimate, tensors] = judged();
  Trial trial;
  add_draws(estimate, tensors, "full@4", trial);
  EXPECT_EQ(trial.curves.count("full@4"), 0U);
  EXPECT_NE(trial.account("full@4"), nullptr);
}

TEST(Draws, CurvesThatAreNotFiniteAreLeftOut) {
  auto [estimate, tensors] = judged();
  tensors.prediction[5] = std::numeric_limits<float>::quiet_NaN();
  Trial trial;
  add_draws(estimate, tensors, "", trial);
  EXPECT_THAT(trial.curves.at("model"), SizeIs(1));
}

TEST(EitherWay, TakesTheSmallerOfEachError) {  // Eq. (4.3)
  const Outcome forward = either_way(test::wave(0.01), test::wave(0));
  const Outcome backward = either_way(reversed(test::wave(0.01)), test::wave(0));
  EXPECT_EQ(forward.index_m, backward.index_m);
  EXPECT_EQ(forward.frechet_m, backward.frechet_m);
  EXPECT_NEAR(forward.index_m, 0.01, 1e-5);
}

}  // namespace
}  // namespace flowdlo::eval
