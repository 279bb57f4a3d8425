#include "vulkan/trial.hpp"

namespace flowdlo::vulkan::testing {
namespace {

/// 256 points around (0.1, -0.2, 0.4); the first `valid` of them count.
std::vector<float> points(std::size_t valid, float spread = 0.1F) {
  std::vector<float> rows = noise(256 * 4, 3, spread);
  for (std::size_t i = 0; i < 256; ++i) {
    rows[4 * i] += 0.1F;
    rows[4 * i + 1] -= 0.2F;
    rows[4 * i + 2] += 0.4F;
    rows[4 * i + 3] = i < valid ? 1.0F : 0.0F;
  }
  return rows;
}

Record frame_normalization(const std::vector<float>& rows) {
  return [=](Trial& trial) {
    const auto visible = trial.input(256, 4, rows);
    const auto norm = trial.output(1, 4);
    trial->record(ops::FrameNormalization{.points = visible, .norm = norm});
  };
}

TEST(FrameNormalization, EqualsItsTwinForAnyNumberOfValidPoints) {
  FLOWDLO_NEEDS_DEVICE();
  for (const std::size_t valid : {1U, 7U, 100U, 256U}) {
    expect_twins(frame_normalization(points(valid)), 1e-5F);
  }
}

TEST(FrameNormalization, HasScaleOneWithoutPointsOrExtent) {
  FLOWDLO_NEEDS_DEVICE();
  for (const auto& device : devices()) {
    EXPECT_EQ(run_on(device, frame_normalization(points(0)))[0], (std::vector<float>{0, 0, 0, 1}));
    EXPECT_EQ(run_on(device, frame_normalization(points(256, 0)))[0][3], 1.0F);
  }
}

TEST(Normalize, AndDenormalizeEqualTheirTwins) {
  FLOWDLO_NEEDS_DEVICE();
  for (const int rows : {64, 192, 256, 4096}) {
    expect_twins(
        [rows](Trial& trial) {
          const auto in = trial.input(rows, 4, noise(static_cast<std::size_t>(rows) * 4, 5));
          const auto norm = trial.input(1, 4, {0.1F, -0.2F, 0.4F, 0.3F});
          const auto there = trial.output(rows, 4);
          const auto back = trial.output(rows, 4);
          trial->record(ops::Normalize{.points = in, .norm = norm, .out = there});
          trial->record(ops::Denormalize{.state = there, .norm = norm, .out = back});
        },
        1e-6F);
  }
}

}  // namespace
}  // namespace flowdlo::vulkan::testing
