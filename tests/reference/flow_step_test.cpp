#include "reference/flow_step.hpp"

#include <gtest/gtest.h>

namespace flowdlo {
namespace {

/// One row whose head output is exactly (1, 2, 3): the hidden row is zero, the bias is the output.
std::vector<float> step(ops::Parameterization parameterization, float t, float dt,
                        std::vector<float> bias = {1, 2, 3}) {
  std::vector<float> state{10, 20, 30, 99};
  const std::vector<float> hidden(256, 0.0F);
  const std::vector<float> weight(bias.size() * 256, 0.5F);
  const std::vector<float> prior{4, 5, 6, 1};
  reference::flow_step({.hidden = {},
                        .head = {},
                        .prior = {},
                        .state = {},
                        .parameterization = parameterization,
                        .prior_sd = 0.5F,
                        .t = t,
                        .dt = dt},
                       hidden, weight, bias, prior, state);
  return state;
}

TEST(FlowStep, VelocityMovesByDtTimesTheOutput) {  // Eq. (3.28): 10 + 0.1 * 1
  const auto state = step(ops::Parameterization::kVelocity, 0.3F, 0.1F);
  EXPECT_FLOAT_EQ(state[0], 10.1F);
  EXPECT_FLOAT_EQ(state[1], 20.2F);
  EXPECT_FLOAT_EQ(state[2], 30.3F);
}

TEST(FlowStep, DirectMovesTowardsTheOutput) {  // Eq. (3.29): 10 + 0.1 * (1 - 10) / (1 - 0.5)
  const auto state = step(ops::Parameterization::kDirect, 0.5F, 0.1F);
  EXPECT_FLOAT_EQ(state[0], 8.2F);
}

TEST(FlowStep, DirectLastStepLandsOnTheOutput) {  // t = 0.9, dt = 0.1: x + (o - x)
  const auto state = step(ops::Parameterization::kDirect, 0.9F, 0.1F);
  EXPECT_NEAR(state[0], 1.0F, 1e-5);
  EXPECT_NEAR(state[2], 3.0F, 1e-5);
}

TEST(FlowStep, PreconditionedAddsTheScaledOutputToTheGaussianVelocity) {
  // t = 0.5, s = 0.5: den = 0.25 * 0.25 + 0.25 = 0.3125; (0.125 - 0.5) / 0.3125 = -1.2;
  // x: 4 - 1.2 * (10 - 2) + 0.5 / sqrt(0.3125) * 1 = -5.6 + 0.894427 = -4.705573
  const auto state = step(ops::Parameterization::kPreconditioned, 0.5F, 0.1F);
  EXPECT_NEAR(state[0], 10.0F - 0.4705573F, 1e-5);
}

TEST(FlowStep, FourthOutputIsKeptBesideTheState) {
  EXPECT_FLOAT_EQ(step(ops::Parameterization::kVelocity, 0, 0.1F, {1, 2, 3, -4})[3], -4.0F);
}

TEST(FlowStep, WithoutAFourthOutputColumnThreeIsZero) {
  EXPECT_FLOAT_EQ(step(ops::Parameterization::kVelocity, 0, 0.1F)[3], 0.0F);
}

}  // namespace
}  // namespace flowdlo
