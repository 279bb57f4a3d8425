#include "vulkan/trial.hpp"

namespace flowdlo::vulkan::testing {
namespace {

constexpr float kTolerance = 2e-5F;  // f32 sums of up to 1024 products in another order

std::size_t count(int rows, int columns) {
  return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
}

Record linear(int draws, int in, int out, ops::Activation activation, bool residual,
              bool in_place = false) {
  return [=](Trial& trial) {
    const int rows = draws * ops::kRowsPerDraw;
    const auto x = trial.input(rows, in, noise(count(rows, in), 3));
    const auto added = trial.input(rows, out, noise(count(rows, out), 4));
    const auto y = trial.output(rows, out);
    const auto layer = trial.layer(out, in, 1);
    if (in_place) trial->record(ops::Copy{.from = added, .to = y});
    ops::Linear op{.x = x, .layer = layer, .y = y, .activation = activation, .residual = {}};
    if (residual) op.residual = in_place ? y : added;
    trial->record(op);
  };
}

class LinearOfWidth : public ::testing::TestWithParam<int> {};

TEST_P(LinearOfWidth, EqualsItsTwin) {
  FLOWDLO_NEEDS_DEVICE();
  for (const int draws : {1, 3, 4}) {
    expect_twins(linear(draws, 256, GetParam(), ops::Activation::kNone, false), kTolerance);
  }
}
INSTANTIATE_TEST_SUITE_P(Columns, LinearOfWidth, ::testing::Values(256, 512, 768, 1024));

TEST(Linear, FromAThousandColumnsEqualsItsTwin) {
  FLOWDLO_NEEDS_DEVICE();
  expect_twins(linear(4, 1024, 256, ops::Activation::kNone, true), kTolerance);
}

TEST(Linear, AppliesGelu) {
  FLOWDLO_NEEDS_DEVICE();
  expect_twins(linear(4, 256, 1024, ops::Activation::kGelu, false), kTolerance);
}

TEST(Linear, AddsTheResidualAfterTheActivation) {
  FLOWDLO_NEEDS_DEVICE();
  expect_twins(linear(1, 256, 256, ops::Activation::kGelu, true), kTolerance);
}

TEST(Linear, AddsAResidualThatIsTheResultItself) {
  FLOWDLO_NEEDS_DEVICE();
  expect_twins(linear(3, 256, 256, ops::Activation::kNone, true, /*in_place=*/true), kTolerance);
}

TEST(Linear, OfSixtyFourDrawsEqualsItsTwinWhateverATexelBufferHolds) {
  FLOWDLO_NEEDS_DEVICE();
  expect_twins(linear(64, 256, 256, ops::Activation::kNone, true), kTolerance);
  expect_twins(linear(12, 1024, 256, ops::Activation::kNone, false), kTolerance);
}

TEST(Linear, WithMoreWeightsThanATexelBufferMustHoldEqualsItsTwin) {
  FLOWDLO_NEEDS_DEVICE();
  expect_twins(linear(1, 1024, 1024, ops::Activation::kNone, true), kTolerance);
}

TEST(Linear, GivesADrawTheSameBitsWhateverTheNumberOfDraws) {
  FLOWDLO_NEEDS_DEVICE();
  for (const auto& device : devices()) {
    const auto one = run_on(device, linear(1, 256, 768, ops::Activation::kNone, false));
    const auto five = run_on(device, linear(5, 256, 768, ops::Activation::kNone, false));
    ASSERT_EQ(one[0].size(), count(64, 768));
    for (std::size_t i = 0; i < one[0].size(); ++i) ASSERT_EQ(one[0][i], five[0][i]) << i;
  }
}

TEST(Linear, OfAnotherShapeThanItsLayerIsReportedByBuild) {
  FLOWDLO_NEEDS_DEVICE();
  Trial trial(create_program(devices().front()));
  const auto x = trial->input("x", 64, 512);
  const auto y = trial->output("y", 64, 256);
  const auto layer = trial.layer(256, 256, 1);
  trial->record(ops::Linear{.x = x, .layer = layer, .y = y, .residual = {}});
  const auto built = trial->build();
  ASSERT_FALSE(built);
  EXPECT_NE(built.error().message.find("Linear: expected x [64 n, 256]"), std::string::npos)
      << built.error().message;
}

}  // namespace
}  // namespace flowdlo::vulkan::testing
