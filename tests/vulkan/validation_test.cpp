#include "vulkan/every_op.hpp"

namespace flowdlo::vulkan::testing {
namespace {

TEST(Validation, HasNothingToSayAboutBuildAndRuns) {
  FLOWDLO_NEEDS_DEVICE();
  for (const DeviceReport& device_report : survey().devices) {
    if (!device_report.lacks.empty()) continue;
    const auto device = open_device({.wanted = device_report.uuid, .validation = true});
    ASSERT_TRUE(device) << device.error().message;
    if (!validation_active(**device)) {
      GTEST_SKIP() << "VK_LAYER_KHRONOS_validation is not installed (vulkan-validationlayers)";
    }
    Trial trial(create_program(*device, {.timeout_ms = 60000, .pipeline_cache = {}}));
    record_every_op(trial);
    trial.run();
    trial.run_again({});
    trial.run_again({});
    EXPECT_EQ(validation_messages(**device), std::vector<std::string>{});
  }
}

}  // namespace
}  // namespace flowdlo::vulkan::testing
