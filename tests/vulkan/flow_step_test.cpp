#include "vulkan/trial.hpp"

namespace flowdlo::vulkan::testing {
namespace {

constexpr float kTolerance = 2e-5F;

Record flow_step(int draws, ops::Parameterization parameterization, int channels, float t) {
  return [=](Trial& trial) {
    const int rows = draws * ops::kRowsPerDraw;
    const auto size = static_cast<std::size_t>(rows) * 4;
    const auto hidden = trial.input(rows, 256, noise(64 * size, 3));
    const auto prior = trial.input(rows, 4, noise(size, 4));
    const auto start = trial.input(rows, 4, noise(size, 5));
    const auto state = trial.output(rows, 4);
    trial->record(ops::Copy{.from = start, .to = state});
    trial->record(ops::FlowStep{.hidden = hidden,
                                .head = trial.layer(channels, 256, 1),
                                .prior = prior,
                                .state = state,
                                .parameterization = parameterization,
                                .prior_sd = 0.15F,
                                .t = t,
                                .dt = 0.1F});
  };
}

TEST(FlowStep, EqualsItsTwinInEveryParameterization) {
  FLOWDLO_NEEDS_DEVICE();
  for (const auto parameterization :
       {ops::Parameterization::kVelocity, ops::Parameterization::kDirect,
        ops::Parameterization::kPreconditioned}) {
    for (const float t : {0.0F, 0.5F, 0.9F}) {
      expect_twins(flow_step(4, parameterization, 3, t), kTolerance);
    }
  }
}

TEST(FlowStep, KeepsLogSigmaWhereTheHeadHasFourChannels) {
  FLOWDLO_NEEDS_DEVICE();
  expect_twins(flow_step(1, ops::Parameterization::kVelocity, 4, 0.2F), kTolerance);
}

TEST(FlowStep, OfSixtyFourDrawsEqualsItsTwin) {
  FLOWDLO_NEEDS_DEVICE();
  expect_twins(flow_step(64, ops::Parameterization::kPreconditioned, 4, 0.4F), kTolerance);
}

}  // namespace
}  // namespace flowdlo::vulkan::testing
