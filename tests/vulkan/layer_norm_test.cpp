#include "vulkan/trial.hpp"

namespace flowdlo::vulkan::testing {
namespace {

Record layer_norm(int rows, float offset) {
  return [=](Trial& trial) {
    std::vector<float> values = noise(static_cast<std::size_t>(rows) * 256, 3);
    for (float& value : values) value += offset;
    const auto x = trial.input(rows, 256, std::move(values));
    const auto gain = trial->constant("gain", 1, 256, noise(256, 4));
    const auto shift = trial->constant("shift", 1, 256, noise(256, 5));
    const auto y = trial.output(rows, 256);
    trial->record(ops::LayerNorm{.x = x, .gain = gain, .shift = shift, .y = y});
  };
}

TEST(LayerNorm, EqualsItsTwinForAnyNumberOfDraws) {
  FLOWDLO_NEEDS_DEVICE();
  for (const int draws : {1, 3, 4, 64}) expect_twins(layer_norm(64 * draws, 0), 1e-5F);
}

TEST(LayerNorm, KeepsItsDigitsWhereTheMeanIsFarFromZero) {
  FLOWDLO_NEEDS_DEVICE();
  expect_twins(layer_norm(64, 300.0F), 2e-4F);  // x itself has no more digits
}

TEST(LayerNorm, OfAConstantRowIsTheShift) {
  FLOWDLO_NEEDS_DEVICE();
  expect_twins(
      [](Trial& trial) {
        const auto x = trial.input(64, 256, std::vector<float>(64 * 256, 2.5F));
        const auto gain = trial->constant("gain", 1, 256, noise(256, 4));
        const auto shift = trial->constant("shift", 1, 256, noise(256, 5));
        const auto y = trial.output(64, 256);
        trial->record(ops::LayerNorm{.x = x, .gain = gain, .shift = shift, .y = y});
      },
      1e-6F);
}

}  // namespace
}  // namespace flowdlo::vulkan::testing
