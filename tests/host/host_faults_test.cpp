// The host's device fails, or is a small one: a driver of our own stands between it and lavapipe.
#include <gmock/gmock.h>

#include "faults/relayed.hpp"
#include "host/host_fixture.hpp"

namespace flowdlo::testing {
namespace {

using ::testing::HasSubstr;

constexpr std::int32_t kLost = VK_ERROR_DEVICE_LOST;

class HostFaults : public Relayed {
 protected:
  /// The wave's frame in a buffer: its depth, then its mask.
  [[nodiscard]] VulkanFrame wave_in(const HostBuffer& buffer) const {
    VulkanFrame frame;
    frame.width = wave_.width;
    frame.height = wave_.height;
    frame.intrinsics = wave_.camera;
    frame.depth_m = {buffer.handle(), 0};
    frame.mask = {buffer.handle(), 4 * wave_.mask.size()};
    return frame;
  }

  WaveFrame wave_{160, 120, 7.0F};
};

TEST_F(HostFaults, LossOfTheDevicePutsTheCpuInItsPlaceAndDestroysNothingOfTheHosts) {
  Config config = host_config();
  config.device = "cpu";
  auto cpu = Estimator::create(config);
  ASSERT_TRUE(cpu);
  const auto expected = bits_of(*cpu, wave_.frame());

  auto program = Host::make({.layers = false});
  ASSERT_NE(program, nullptr);
  const long of_host = relay()->alive();
  {
    config.device = "auto";
    auto made = Estimator::create(config, program->handed_over());
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_NE(made->device(), "cpu");
    EXPECT_GT(relay()->alive(), of_host);
    relay()->fail("vkQueueSubmit", 1, kLost);
    const auto estimate = made->estimate(wave_.frame());
    ASSERT_TRUE(estimate) << estimate.error().message;
    EXPECT_TRUE(relay()->failed());
    EXPECT_EQ(made->device(), "cpu");
    EXPECT_TRUE(bits_of(*made, wave_.frame()) == expected);
    EXPECT_EQ(relay()->calls("vkDestroyDevice"), 0);
  }
  EXPECT_EQ(relay()->alive(), of_host) << "the estimator's objects are gone, the host's are not";
  EXPECT_EQ(relay()->calls("vkDestroyDevice"), 0);
  EXPECT_EQ(relay()->calls("vkDestroyInstance"), 0);
}

TEST_F(HostFaults, LossOfTheDeviceIsAnErrorWhereTheDeviceWasAskedFor) {
  auto program = Host::make({.layers = false});
  ASSERT_NE(program, nullptr);
  auto made = Estimator::create(host_config(), program->handed_over());
  ASSERT_TRUE(made) << made.error().message;
  HostBuffer buffer(*program, 5 * wave_.mask.size());
  const VulkanFrame frame = wave_in(buffer);
  EXPECT_TRUE(made->fetch(frame));
  for (const char* const function : {"vkQueueSubmit", "vkWaitForFences"}) {
    relay()->fail(function, 1, kLost);
    const auto fetched = made->fetch(frame);
    ASSERT_FALSE(fetched);
    EXPECT_EQ(fetched.error().code, ErrorCode::kDeviceLost);
  }
  const auto estimate = made->estimate(wave_.frame());
  ASSERT_FALSE(estimate);
  EXPECT_EQ(estimate.error().code, ErrorCode::kDeviceLost);
}

/// Each call that a fetch makes fails once: an error, and the next fetch works.
TEST_F(HostFaults, AFetchThatFailsLeavesTheNextOneAsItWas) {
  auto program = Host::make({.layers = false});
  ASSERT_NE(program, nullptr);
  auto made = Estimator::create(host_config(), program->handed_over());
  ASSERT_TRUE(made) << made.error().message;
  HostBuffer buffer(*program, 5 * wave_.mask.size());
  buffer.bytes()[4 * wave_.mask.size()] = 200;
  const VulkanFrame frame = wave_in(buffer);
  for (const char* const function :
       {"vkCreateBuffer", "vkAllocateMemory", "vkBindBufferMemory", "vkMapMemory",
        "vkCreateCommandPool", "vkCreateFence", "vkAllocateCommandBuffers", "vkBeginCommandBuffer",
        "vkEndCommandBuffer", "vkResetFences", "vkQueueSubmit"}) {
    SCOPED_TRACE(function);
    relay()->fail(function, 1, VK_ERROR_OUT_OF_HOST_MEMORY);
    const auto refused = made->fetch(frame);
    EXPECT_TRUE(relay()->failed());
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::kOutOfMemory) << refused.error().message;
    relay()->reset();
    if (std::string(function).find("vkCreate") == 0 ||
        std::string(function) == "vkAllocateMemory" ||
        std::string(function) == "vkBindBufferMemory" || std::string(function) == "vkMapMemory" ||
        std::string(function) == "vkAllocateCommandBuffers") {
      continue;  // they are called once alone
    }
    const auto fetched = made->fetch(frame);
    ASSERT_TRUE(fetched) << fetched.error().message;
    EXPECT_EQ(fetched->mask[0], 200);
  }
}

/// As MoltenVK's.
TEST_F(HostFaults, ADeviceWithASubsetOfVulkanMustHaveBeenMadeWithItsExtension) {
  const test::Drivers portable(FLOWDLO_RELAY_PORTABILITY);
  relay()->limit({.portability = true});
  auto program = Host::make({.features = false});
  ASSERT_NE(program, nullptr);
  EXPECT_TRUE(program->needs().required.portability_subset);
  EXPECT_THAT(program->needs().extensions,
              ::testing::Contains(::testing::StrEq("VK_KHR_portability_subset")));
  EXPECT_TRUE(Estimator::create(host_config(), program->handed_over()));
  VulkanHost without = program->handed_over();
  without.enabled.portability_subset = false;
  const auto refused = Estimator::create(host_config(), without);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kNoDevice);
  EXPECT_THAT(refused.error().message, HasSubstr("lacks VK_KHR_portability_subset"));
  const auto heard = program->heard();
  program.reset();
  EXPECT_THAT(heard->messages, ::testing::IsEmpty());
}

TEST_F(HostFaults, ADeviceThatLacksSomethingIsNamedWithIt) {
  relay()->limit({.float_texels = false});
  auto program = Host::make({.layers = false});
  ASSERT_NE(program, nullptr);
  EXPECT_THAT(program->needs().lacks, ::testing::ElementsAre("uniform texel buffers of RGBA32F"));
  for (const char* const device : {"auto", "vulkan"}) {
    Config config = host_config();
    config.device = device;
    const auto refused = Estimator::create(config, program->handed_over());
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::kNoDevice);
    EXPECT_THAT(refused.error().message, HasSubstr("lacks uniform texel buffers of RGBA32F"));
  }
}

}  // namespace
}  // namespace flowdlo::testing
