// What stays of a GPU when its estimators go: its driver, and what was measured of it.
#include <gtest/gtest.h>

#include <string>

#include "faults/relayed.hpp"
#include "flowdlo/estimator.hpp"
#include "support/forked.hpp"
#include "vulkan/backend.hpp"
#include "vulkan/findings.hpp"
#include "vulkan/kept_drivers.hpp"

namespace flowdlo::testing {
namespace {

class GpuMemory : public Relayed {
 protected:
  static void open_and_close() {
    const auto device = vulkan::open_device({.wanted = "vulkan", .probing = {.on = false}});
    ASSERT_TRUE(device) << device.error().message;
  }
};

TEST_F(GpuMemory, ItsDriverStaysLoaded) {
  relay()->pose_as_gpu(true);
  open_and_close();
  const long instances = relay()->calls("vkCreateInstance");
  EXPECT_EQ(relay()->alive(), 1) << "an instance";
  open_and_close();
  EXPECT_EQ(relay()->calls("vkCreateInstance"), 2 * instances);
  EXPECT_EQ(relay()->alive(), 1) << "one is enough";
  vulkan::forget_drivers();
  EXPECT_EQ(relay()->alive(), 0);
}

TEST_F(GpuMemory, AForkedProcessLeavesTheDriverAlone) {
  relay()->pose_as_gpu(true);
  open_and_close();
  const long destroyed = relay()->calls("vkDestroyInstance");
  EXPECT_EQ(forked([&] {
              vulkan::forget_drivers();
              return relay()->calls("vkDestroyInstance") == destroyed ? 0 : 1;
            }),
            0);
  EXPECT_EQ(relay()->alive(), 1);
}

TEST_F(GpuMemory, OfACpuDriverNothingStays) {
  open_and_close();
  EXPECT_EQ(relay()->alive(), 0);
}

/// Lavapipe takes 3 s to compile a GPU's kernels.
TEST_F(GpuMemory, WhereTheFieldRunsIsFoundOutOnce) {
  relay()->pose_as_gpu(true);
  const Config config{.weights = FLOWDLO_DEFAULT_WEIGHTS,
                      .device = "vulkan",
                      .threads = 2,
                      .max_width = 160,
                      .max_height = 120,
                      .device_timeout_ms = 120000};
  const auto submits_of = [&](std::string& field_device) {
    const long before = relay()->calls("vkQueueSubmit");
    const auto made = Estimator::create(config);
    EXPECT_TRUE(made) << made.error().message;
    if (made) field_device = made->field_device();
    return relay()->calls("vkQueueSubmit") - before;
  };
  std::string first;
  std::string second;
  constexpr long kTrial = 3;  // runs of the network
  const long once = submits_of(first);
  EXPECT_FALSE(first.empty());
  EXPECT_LE(submits_of(second), once - kTrial) << "nothing is tried again";
  EXPECT_EQ(second, first);
  vulkan::forget_findings();  // a new process: FLOWDLO_CACHE has it
  EXPECT_LE(submits_of(second), once - kTrial);
  EXPECT_EQ(second, first);
}

}  // namespace
}  // namespace flowdlo::testing
