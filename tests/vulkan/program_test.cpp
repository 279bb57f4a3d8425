#include <chrono>

#include "vulkan/every_op.hpp"

namespace flowdlo::vulkan::testing {
namespace {

std::unique_ptr<ops::Program> program_on(const std::shared_ptr<Device>& device) {
  return create_program(device, {.timeout_ms = 60000, .pipeline_cache = {}});
}

TEST(Program, OfEveryOperationEqualsItsTwin) {
  FLOWDLO_NEEDS_DEVICE();
  expect_twins(record_every_op, 1e-4F);
}

TEST(Program, GivesTheSameBitsEveryTime) {
  FLOWDLO_NEEDS_DEVICE();
  for (const auto& device : devices()) {
    Trial trial(program_on(device));
    record_every_op(trial);
    const Outputs first = trial.run();
    EXPECT_EQ(first, trial.run_again({}));
    EXPECT_EQ(first, run_on(device, record_every_op)) << "a second program";
  }
}

TEST(Program, MakesOneSubmissionARun) {
  FLOWDLO_NEEDS_DEVICE();
  for (const auto& device : devices()) {
    Trial trial(program_on(device));
    record_every_op(trial);
    trial.run();
    const std::uint64_t before = submit_count(*device);
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(trial->run());
    EXPECT_EQ(submit_count(*device), before + 3);
  }
}

TEST(Program, TimesItsStagesInOrderOfFirstAppearance) {
  FLOWDLO_NEEDS_DEVICE();
  for (const auto& device : devices()) {
    Trial trial(program_on(device));
    record_every_op(trial);
    trial.run();
    const auto times = trial->stage_times_ms();
    if (times.size() == 1) {
      EXPECT_EQ(times[0].first, "total");  // a device without timestamps
      continue;
    }
    ASSERT_EQ(times.size(), 4U);
    EXPECT_EQ(times[0].first, "evidence");
    EXPECT_EQ(times[1].first, "features");
    EXPECT_EQ(times[2].first, "blocks");
    EXPECT_EQ(times[3].first, "image");
    for (const auto& [name, ms] : times) EXPECT_GT(ms, 0) << name;
  }
}

TEST(Program, TakesInputsWrittenBeforeItIsBuilt) {
  FLOWDLO_NEEDS_DEVICE();
  for (const auto& device : devices()) {
    const auto program = program_on(device);
    const auto x = program->input("x", 64, 4);
    const auto y = program->output("y", 64, 4);
    program->record(ops::Copy{.from = x, .to = y});
    const std::vector<float> values = noise(64 * 4, 1);
    program->write(x, values);
    ASSERT_TRUE(program->build());
    ASSERT_TRUE(program->run());
    std::vector<float> copied(values.size());
    program->read(y, copied);
    EXPECT_EQ(copied, values);
  }
}

TEST(Program, BeforeBuildDoesNotRun) {
  FLOWDLO_NEEDS_DEVICE();
  const auto program = program_on(devices().front());
  const auto done = program->run();
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::kInternal);
}

/// 2 GFLOP: far more than a millisecond on a CPU driver, and a few seconds at most.
void record_long_work(Trial& trial) {
  const auto x = trial.input(1024, 256, noise(1024 * 256, 1));
  const auto y = trial->scratch("y", 1024, 1024);
  const auto z = trial.output(1024, 256);
  const auto up = trial.layer(1024, 256, 2);
  const auto down = trial.layer(256, 1024, 3);
  for (int i = 0; i < 2; ++i) {
    trial->record(ops::Linear{.x = x, .layer = up, .y = y, .residual = {}});
    trial->record(ops::Linear{.x = y, .layer = down, .y = z, .residual = {}});
  }
}

TEST(Program, PastItsTimeoutIsLostForGoodWithinABoundedTime) {
  FLOWDLO_NEEDS_DEVICE();
  for (const auto& device : devices()) {
    if (report(*device).kind != DeviceKind::kCpu) continue;  // a GPU may finish in time
    const auto start = std::chrono::steady_clock::now();
    {
      Trial trial(create_program(device, {.timeout_ms = 1, .pipeline_cache = {}}));
      record_long_work(trial);
      ASSERT_TRUE(trial->build());
      const auto done = trial->run();
      ASSERT_FALSE(done);
      EXPECT_EQ(done.error().code, ErrorCode::kDeviceLost);
      EXPECT_NE(done.error().message.find("within 1 ms"), std::string::npos);
      const auto again = trial->run();
      ASSERT_FALSE(again);
      EXPECT_EQ(again.error().message, done.error().message);
    }
    const auto elapsed = std::chrono::steady_clock::now() - start;
    EXPECT_LT(elapsed, std::chrono::seconds(90)) << "a hung device must not hang its host";
    EXPECT_EQ(run_on(device, record_every_op).size(), 5U) << "the device itself is still usable";
  }
}

}  // namespace
}  // namespace flowdlo::vulkan::testing
