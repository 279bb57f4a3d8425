#include "vulkan/device.hpp"
#include "vulkan/every_op.hpp"
#include "vulkan/gemm_candidates.hpp"
#include "weights/half.hpp"

namespace flowdlo::vulkan::testing {
namespace {

constexpr float kTolerance = 2e-5F;        // f32 sums of up to 1024 products in another order
constexpr float kMatrixTolerance = 2e-3F;  // x rounded to f16

std::size_t count(int rows, int columns) {
  return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
}

struct Shape {
  int draws;
  int in;
  int out;
  ops::Activation activation;
  bool residual;
  bool halves;  // weights that f16 holds
};

Record linear(const Shape& shape) {
  return [=](Trial& trial) {
    const int rows = shape.draws * ops::kRowsPerDraw;
    const auto x = trial.input(rows, shape.in, noise(count(rows, shape.in), 3));
    const auto y = trial.output(rows, shape.out);
    auto weight = noise(count(shape.out, shape.in), 1, 1.0F / 16);
    if (shape.halves) {
      for (float& value : weight) value = weights::half_to_float(weights::float_to_half(value));
    }
    const auto layer = trial->layer("layer", shape.out, shape.in, weight,
                                    noise(static_cast<std::size_t>(shape.out), 2));
    ops::Linear op{.x = x, .layer = layer, .y = y, .activation = shape.activation, .residual = {}};
    if (shape.residual) {  // the result itself, as in the model
      const auto added = trial.input(rows, shape.out, noise(count(rows, shape.out), 4));
      trial->record(ops::Copy{.from = added, .to = y});
      op.residual = y;
    }
    trial->record(op);
  };
}

Outputs run_with(const std::shared_ptr<Device>& device, const GemmChoice& choice,
                 const Record& record) {
  Trial trial(create_program(device, {.timeout_ms = 60000, .pipeline_cache = {}, .gemm = choice}));
  record(trial);
  return trial.run();
}

/// Every candidate of every device, tiles of every size among them.
void expect_twins_of_all(const Shape& shape) {
  const Outputs expected = run_on_cpu(linear(shape));
  for (const auto& device : devices()) {
    for (const GemmChoice& choice : gemm_candidates(device->facts())) {
      SCOPED_TRACE(report(*device).name + ", " + name_of(choice));
      const bool is_matrix = choice.family == GemmFamily::kMatrix;
      expect_near(expected[0], run_with(device, choice, linear(shape))[0],
                  is_matrix ? kMatrixTolerance : kTolerance);
    }
  }
}

TEST(GemmCandidates, AlwaysHoldATile) {
  FLOWDLO_NEEDS_DEVICE();
  for (const auto& device : devices()) {
    const auto candidates = gemm_candidates(device->facts());
    EXPECT_TRUE(std::any_of(candidates.begin(), candidates.end(), [](const GemmChoice& choice) {
      return choice.family == GemmFamily::kTile;
    }));
  }
}

TEST(GemmCandidates, BeginWithShufflesOnCpuDriversOnly) {
  PhysicalDevice device;
  device.lanes = 32;
  device.limits.maxComputeWorkGroupInvocations = 1024;
  device.limits.maxComputeWorkGroupSize[0] = 1024;
  device.limits.maxComputeSharedMemorySize = 49152;
  device.limits.maxPerStageDescriptorStorageBuffers = 16;
  device.report.kind = DeviceKind::kCpu;
  EXPECT_EQ(gemm_candidates(device).front().family, GemmFamily::kSimd);
  device.report.kind = DeviceKind::kDiscreteGpu;
  EXPECT_NE(gemm_candidates(device).front().family, GemmFamily::kSimd);
}

TEST(GemmCandidates, FitTheLimitsOfASmallDevice) {
  PhysicalDevice device;
  device.lanes = 128;
  device.report.kind = DeviceKind::kIntegratedGpu;
  device.limits.maxComputeWorkGroupInvocations = 128;  // what Vulkan promises
  device.limits.maxComputeWorkGroupSize[0] = 128;
  device.limits.maxComputeSharedMemorySize = 16384;
  device.limits.maxPerStageDescriptorStorageBuffers = 4;
  for (const GemmChoice& choice : gemm_candidates(device)) {
    EXPECT_EQ(choice.family, GemmFamily::kTile) << "shuffles of 128 lanes do not fit a panel";
    EXPECT_LE(threads_of(choice, device), 128);
  }
  EXPECT_FALSE(gemm_candidates(device).empty());
}

TEST(GemmCandidates, NeedNoShufflesWhereThereAreNone) {
  PhysicalDevice device;
  device.lanes = 16;
  device.shuffles = false;
  device.limits.maxComputeWorkGroupInvocations = 256;
  device.limits.maxComputeWorkGroupSize[0] = 256;
  device.limits.maxComputeSharedMemorySize = 16384;
  device.limits.maxPerStageDescriptorStorageBuffers = 4;
  for (const DeviceKind kind : {DeviceKind::kCpu, DeviceKind::kIntegratedGpu}) {
    device.report.kind = kind;
    ASSERT_FALSE(gemm_candidates(device).empty());
    for (const GemmChoice& choice : gemm_candidates(device)) {
      EXPECT_EQ(choice.family, GemmFamily::kTile);
    }
  }
}

TEST(TileGemm, EqualsItsTwinInEveryShapeOfTheModel) {
  FLOWDLO_NEEDS_DEVICE();
  expect_twins_of_all({4, 256, 256, ops::Activation::kNone, true, true});
  expect_twins_of_all({1, 256, 768, ops::Activation::kNone, false, true});
  expect_twins_of_all({3, 256, 1024, ops::Activation::kGelu, false, true});
  expect_twins_of_all({5, 1024, 256, ops::Activation::kNone, true, true});
  expect_twins_of_all({2, 256, 512, ops::Activation::kGelu, true, true});
}

TEST(TileGemm, EqualsItsTwinWithWeightsThatNoF16Holds) {
  FLOWDLO_NEEDS_DEVICE();
  expect_twins_of_all({3, 256, 256, ops::Activation::kNone, true, false});
  expect_twins_of_all({1, 1024, 256, ops::Activation::kNone, false, false});
}

TEST(TileGemm, GivesADrawTheSameBitsWhateverTheNumberOfDraws) {
  FLOWDLO_NEEDS_DEVICE();
  // 44 draws make 64 x 64 tiles of 768 columns many enough to be taken instead of small ones.
  const Shape one{1, 256, 768, ops::Activation::kNone, false, true};
  const Shape many{44, 256, 768, ops::Activation::kNone, false, true};
  for (const auto& device : devices()) {
    for (const GemmChoice& choice : gemm_candidates(device->facts())) {
      if (choice.rows != 32) continue;
      SCOPED_TRACE(report(*device).name + ", " + name_of(choice));
      const Outputs alone = run_with(device, choice, linear(one));
      const Outputs among = run_with(device, choice, linear(many));
      ASSERT_EQ(alone[0].size(), count(64, 768));
      for (std::size_t i = 0; i < alone[0].size(); ++i) ASSERT_EQ(alone[0][i], among[0][i]) << i;
    }
  }
}

TEST(TileGemm, LeavesTheValidationLayersSilent) {
  FLOWDLO_NEEDS_DEVICE();
  for (const DeviceReport& device_report : survey().devices) {
    if (!device_report.lacks.empty()) continue;
    const auto device = open_device({.wanted = device_report.uuid, .validation = true});
    ASSERT_TRUE(device) << device.error().message;
    if (!validation_active(**device)) {
      GTEST_SKIP() << "VK_LAYER_KHRONOS_validation is not installed (vulkan-validationlayers)";
    }
    for (const GemmChoice& choice : gemm_candidates((*device)->facts())) {
      SCOPED_TRACE(name_of(choice));
      Trial trial(
          create_program(*device, {.timeout_ms = 60000, .pipeline_cache = {}, .gemm = choice}));
      record_every_op(trial);
      trial.run();
      trial.run_again({});
      EXPECT_EQ(validation_messages(**device), std::vector<std::string>{});
    }
  }
}

}  // namespace
}  // namespace flowdlo::vulkan::testing
