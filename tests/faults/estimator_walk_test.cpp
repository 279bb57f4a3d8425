// An estimator whose device fails, when it is made and within a frame.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "faults/relayed.hpp"
#include "faults/walk.hpp"
#include "flowdlo/devices.hpp"
#include "flowdlo/estimator.hpp"
#include "support/estimate_bits.hpp"
#include "support/wave_frame.hpp"
#include "vulkan/vulkan_api.hpp"

namespace flowdlo::testing {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// Lavapipe that poses as a GPU compiles a GPU's kernels, on a busy machine for longer than a GPU
/// is given: "auto" would then take the CPU before anything is made to fail.
Config config(const char* device) {
  return {.weights = FLOWDLO_WEIGHTS,
          .device = device,
          .euler_steps = 1,
          .draws = 1,
          .threads = 2,
          .max_width = 160,
          .max_height = 120,
          .device_timeout_ms = 120000};
}

class EstimatorWalk : public Relayed {
 protected:
  /// Of the first frame on the device that is back; until then each has an estimate, the CPU's.
  std::string bits_once_back(Estimator& estimator, const std::string& on_cpu) const {
    const auto patience = std::chrono::steady_clock::now() + seconds(120);
    std::string last;
    while (estimator.device() == "cpu" && std::chrono::steady_clock::now() < patience) {
      const auto estimate = estimator.estimate(wave_.frame());
      if (!estimate) return estimate.error().message;
      last = bits_of(*estimate);
      if (estimator.device() == "cpu") {
        EXPECT_EQ(last, on_cpu);
      }
      std::this_thread::sleep_for(milliseconds(20));
    }
    return last;
  }

  WaveFrame wave_{160, 120, 7.0F};
};

TEST_F(EstimatorWalk, CreateEndsInAnErrorOrAnEstimatorThatIsRight) {
  walk(
      [&](bool /*layers*/) -> Result<std::string> {
        auto made = Estimator::create(config("vulkan"));
        if (!made) return made.error();
        auto estimate = made->estimate(wave_.frame());
        if (!estimate) return estimate.error();
        return bits_of(*estimate);
      },
      Thoroughly::kFirstAlone);
}

/// The calls that a frame makes. A device asked for by name fails in each with each result: the
/// frame ends in an Error or in the right bits. With "auto" each call fails with its last result
/// alone, and the frame has an estimate, the device's or the CPU's. "auto" takes lavapipe only
/// where it poses as a GPU, whose kernels take it 3 s to compile; FLOWDLO_LONG_TESTS walks every
/// result that way.
TEST_F(EstimatorWalk, EachCallWithinAFrameEndsAsPromised) {
  const std::vector<std::pair<const char*, std::vector<VkResult>>> calls = {
      {"vkResetFences", {VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_OUT_OF_DEVICE_MEMORY}},
      {"vkQueueSubmit",
       {VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_DEVICE_LOST}},
      {"vkWaitForFences",
       {VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_DEVICE_LOST,
        VK_TIMEOUT}},
      {"vkGetQueryPoolResults", {VK_ERROR_OUT_OF_HOST_MEMORY, VK_NOT_READY}}};
  auto cpu = Estimator::create(config("cpu"));
  ASSERT_TRUE(cpu);
  const std::string on_cpu = bits_of(*cpu->estimate(wave_.frame()));
  const bool thorough = std::getenv("FLOWDLO_LONG_TESTS") != nullptr;
  for (const char* const device : {"vulkan", "auto"}) {
    const bool by_name = device == std::string("vulkan");
    relay()->pose_as_gpu(!by_name || thorough);
    std::string on_device;
    for (const auto& [function, results] : calls) {
      for (const VkResult result : results) {
        if (!by_name && !thorough && result != results.back()) continue;
        SCOPED_TRACE(std::string(device) + ", " + function + ": " + std::to_string(result));
        auto made = Estimator::create(config(device));
        ASSERT_TRUE(made) << made.error().message;
        if (on_device.empty()) on_device = bits_of(*made->estimate(wave_.frame()));
        relay()->fail(function, 1, result);
        const auto estimate = made->estimate(wave_.frame());
        EXPECT_TRUE(relay()->failed());
        relay()->reset();
        if (!estimate) {
          EXPECT_STREQ(device, "vulkan");
          EXPECT_EQ(estimate.error().code, ErrorCode::kDeviceLost);
          EXPECT_FALSE(made->estimate(wave_.frame())) << "a lost device stays lost";
          continue;
        }
        EXPECT_TRUE(bits_of(*estimate) == (made->device() == "cpu" ? on_cpu : on_device));
        EXPECT_TRUE(made->estimate(wave_.frame()));
      }
    }
  }
}

TEST_F(EstimatorWalk, AutoAlwaysEstimates) {
  relay()->pose_as_gpu(true);
  for (const auto& [function, result] :
       {std::pair{"vkCreateInstance", VK_ERROR_INITIALIZATION_FAILED},
        std::pair{"vkEnumeratePhysicalDevices", VK_ERROR_INITIALIZATION_FAILED},
        std::pair{"vkCreateDevice", VK_ERROR_DEVICE_LOST},
        std::pair{"vkAllocateMemory", VK_ERROR_OUT_OF_DEVICE_MEMORY},
        std::pair{"vkCreateComputePipelines", VK_ERROR_OUT_OF_DEVICE_MEMORY},
        std::pair{"vkQueueSubmit", VK_ERROR_DEVICE_LOST},
        std::pair{"vkWaitForFences", VK_ERROR_DEVICE_LOST}}) {
    SCOPED_TRACE(function);
    relay()->fail(function, 1, result);
    auto made = Estimator::create(config("auto"));
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_TRUE(relay()->failed());
    const auto estimate = made->estimate(wave_.frame());
    ASSERT_TRUE(estimate) << estimate.error().message;
    EXPECT_EQ(made->device(), "cpu");
  }
}

/// Every frame has an estimate while the device is lost, tried again and back.
TEST_F(EstimatorWalk, AutoComesBackToADeviceThatWasLost) {
  relay()->pose_as_gpu(true);
  auto made = Estimator::create(config("auto"));
  ASSERT_TRUE(made) << made.error().message;
  ASSERT_EQ(made->device(), "Relayed GPU");
  const std::string on_device = bits_of(*made->estimate(wave_.frame()));
  auto cpu = Estimator::create(config("cpu"));
  ASSERT_TRUE(cpu);
  const std::string on_cpu = bits_of(*cpu->estimate(wave_.frame()));

  relay()->hide(true);  // the driver is being reset
  relay()->fail("vkQueueSubmit", 1, VK_ERROR_DEVICE_LOST);
  const auto within = made->estimate(wave_.frame());
  ASSERT_TRUE(within) << within.error().message;
  EXPECT_EQ(made->device(), "cpu");
  EXPECT_EQ(bits_of(*within), on_cpu);

  // Tries after 1 s find nothing, and no frame waits for them.
  const auto until = std::chrono::steady_clock::now() + milliseconds(1500);
  while (std::chrono::steady_clock::now() < until) {
    ASSERT_TRUE(made->estimate(wave_.frame()));
    EXPECT_EQ(made->device(), "cpu");
  }
  relay()->reset();
  relay()->hide(false);
  EXPECT_EQ(bits_once_back(*made, on_cpu), on_device);
  EXPECT_EQ(made->device(), "Relayed GPU");
}

TEST_F(EstimatorWalk, EstimateOfADeviceAskedForByNameEndsInAnError) {
  auto made = Estimator::create(config("vulkan"));
  ASSERT_TRUE(made) << made.error().message;
  relay()->fail("vkWaitForFences", 1, VK_ERROR_DEVICE_LOST);
  const auto lost = made->estimate(wave_.frame());
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().code, ErrorCode::kDeviceLost);
  relay()->reset();
  EXPECT_EQ(made->estimate(wave_.frame()).error().code, ErrorCode::kDeviceLost) << "it stays lost";
  auto next = Estimator::create(config("vulkan"));
  ASSERT_TRUE(next) << next.error().message;
  EXPECT_TRUE(next->estimate(wave_.frame()));
}

/// With the weights that ship, whose strand field sees every frame before anything else does; the
/// model is idle.
Config with_field(const char* device) {
  Config made = config(device);
  made.weights = FLOWDLO_DEFAULT_WEIGHTS;
  made.quality = Quality::kFast;
  made.field_device = FieldDevice::kSame;
  return made;
}

class FieldWalk : public EstimatorWalk {
 protected:
  [[nodiscard]] std::string on_cpu() const {
    auto cpu = Estimator::create(with_field("cpu"));
    return cpu ? bits_of(*cpu->estimate(wave_.frame())) : cpu.error().message;
  }
};

TEST_F(FieldWalk, AutoPutsTheCpuInThePlaceOfADeviceThatTheFieldHasLostAndComesBack) {
  relay()->pose_as_gpu(true);
  auto made = Estimator::create(with_field("auto"));
  ASSERT_TRUE(made) << made.error().message;
  ASSERT_EQ(made->device(), "Relayed GPU");
  ASSERT_EQ(made->field_device(), "Relayed GPU");
  const std::string on_device = bits_of(*made->estimate(wave_.frame()));
  const std::string cpu_bits = on_cpu();

  relay()->hide(true);
  relay()->fail("vkQueueSubmit", 1, VK_ERROR_DEVICE_LOST);
  const auto within = made->estimate(wave_.frame());
  ASSERT_TRUE(within) << within.error().message;
  EXPECT_TRUE(relay()->failed());
  EXPECT_EQ(made->field_device(), "cpu");
  EXPECT_EQ(bits_of(*within), cpu_bits);
  ASSERT_TRUE(made->estimate(wave_.frame()));
  EXPECT_EQ(made->device(), "cpu");

  relay()->reset();
  relay()->hide(false);
  EXPECT_EQ(bits_once_back(*made, cpu_bits), on_device);
  EXPECT_EQ(made->device(), "Relayed GPU");
  EXPECT_EQ(made->field_device(), "Relayed GPU");
}

TEST_F(FieldWalk, ADeviceAskedForByNameEndsInAnErrorWhereTheFieldLosesIt) {
  auto made = Estimator::create(with_field("vulkan"));
  ASSERT_TRUE(made) << made.error().message;
  ASSERT_EQ(made->field_device(), made->device());
  ASSERT_TRUE(made->estimate(wave_.frame()));
  relay()->fail("vkWaitForFences", 1, VK_ERROR_DEVICE_LOST);
  const auto lost = made->estimate(wave_.frame());
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().code, ErrorCode::kDeviceLost);
  relay()->reset();
  EXPECT_EQ(made->estimate(wave_.frame()).error().code, ErrorCode::kDeviceLost) << "it stays lost";
}

TEST_F(FieldWalk, AutoTakesTheCpuWhereTheFieldCannotBeMadeOnTheDevice) {
  relay()->pose_as_gpu(true);
  const std::string cpu_bits = on_cpu();
  for (const auto& [function, result] :
       {std::pair{"vkAllocateMemory", VK_ERROR_OUT_OF_DEVICE_MEMORY},
        std::pair{"vkQueueSubmit", VK_ERROR_DEVICE_LOST}}) {
    SCOPED_TRACE(function);
    relay()->fail(function, 1, result);
    auto made = Estimator::create(with_field("auto"));
    ASSERT_TRUE(made) << made.error().message;
    const auto estimate = made->estimate(wave_.frame());
    ASSERT_TRUE(estimate) << estimate.error().message;
    EXPECT_EQ(made->field_device(), "cpu");
    EXPECT_EQ(bits_of(*estimate), cpu_bits);
    relay()->reset();
  }
}

/// Lavapipe is no GPU: a trial finds the CPU back end faster, and the model stays where it was.
TEST_F(FieldWalk, ATrialSaysWhereTheFieldIsFaster) {
  relay()->pose_as_gpu(true);
  Config tried = with_field("auto");
  tried.field_device = FieldDevice::kFaster;
  auto made = Estimator::create(tried);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->device(), "Relayed GPU");
  EXPECT_EQ(made->field_device(), "cpu");
  EXPECT_EQ(bits_of(*made->estimate(wave_.frame())), on_cpu());
}

}  // namespace
}  // namespace flowdlo::testing
