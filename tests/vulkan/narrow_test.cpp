#include <limits>

#include "vulkan/trial.hpp"

namespace flowdlo::vulkan::testing {
namespace {

constexpr float kTolerance = 1e-5F;

Record narrow(int draws, int x_columns, int in, ops::Activation activation, int addends) {
  return [=](Trial& trial) {
    const int rows = draws * ops::kRowsPerDraw;
    const auto x_size = static_cast<std::size_t>(rows) * static_cast<std::size_t>(x_columns);
    const auto x = trial.input(rows, x_columns, noise(x_size, 3));
    const auto nodes = trial->constant("nodes", 64, 256, noise(64 * 256, 4));
    const auto times = trial->constant("times", 10, 256, noise(10 * 256, 5));
    const auto y = trial.output(rows, 256);
    ops::Narrow op{.x = x,
                   .layer = trial.layer(256, in, 1),
                   .y = y,
                   .activation = activation,
                   .first = {},
                   .second = {}};
    if (addends > 0) op.first = ops::Addend{.table = nodes, .period = 64, .offset = 0};
    if (addends > 1) op.second = ops::Addend{.table = times, .period = 1, .offset = 7};
    trial->record(op);
  };
}

TEST(Narrow, EqualsItsTwinForEveryNumberOfInputs) {
  FLOWDLO_NEEDS_DEVICE();
  for (const int in : {1, 3, 4}) {
    expect_twins(narrow(3, 4, in, ops::Activation::kNone, 0), kTolerance);
  }
  for (const int in : {6, 8}) {
    expect_twins(narrow(4, 8, in, ops::Activation::kGelu, 0), kTolerance);
  }
}

TEST(Narrow, AddsRowsOfTables) {
  FLOWDLO_NEEDS_DEVICE();
  expect_twins(narrow(4, 4, 3, ops::Activation::kNone, 1), kTolerance);
  expect_twins(narrow(4, 4, 3, ops::Activation::kNone, 2), kTolerance);
}

TEST(Narrow, OfSixtyFourDrawsWithATableAsLargeEqualsItsTwin) {
  FLOWDLO_NEEDS_DEVICE();
  expect_twins(
      [](Trial& trial) {
        const auto x = trial.input(4096, 4, noise(4096 * 4, 3));
        const auto table = trial->constant("table", 4096, 256, noise(4096 * 256, 4));
        const auto y = trial.output(4096, 256);
        trial->record(ops::Narrow{.x = x,
                                  .layer = trial.layer(256, 3, 1),
                                  .y = y,
                                  .activation = ops::Activation::kNone,
                                  .first = ops::Addend{.table = table, .period = 4096, .offset = 0},
                                  .second = {}});
      },
      kTolerance);
}

TEST(Narrow, LooksAtNoColumnBeyondTheLayersInputs) {
  FLOWDLO_NEEDS_DEVICE();
  const auto record = [](float beyond) {
    return [beyond](Trial& trial) {
      std::vector<float> values = noise(64 * 4, 3);
      for (std::size_t row = 0; row < 64; ++row) values[4 * row + 3] = beyond;
      const auto x = trial.input(64, 4, values);
      const auto y = trial.output(64, 256);
      trial->record(ops::Narrow{.x = x,
                                .layer = trial.layer(256, 3, 1),
                                .y = y,
                                .activation = ops::Activation::kNone,
                                .first = {},
                                .second = {}});
    };
  };
  for (const auto& device : devices()) {
    EXPECT_EQ(run_on(device, record(0)),
              run_on(device, record(std::numeric_limits<float>::quiet_NaN())));
  }
}

}  // namespace
}  // namespace flowdlo::vulkan::testing
