#include "faults/walk.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <map>
#include <set>
#include <vector>

#include "faults/relayed.hpp"
#include "vulkan/check.hpp"
#include "vulkan/findings.hpp"
#include "vulkan/kept_drivers.hpp"

namespace flowdlo::testing {
namespace {

struct Fallible {
  const char* function;
  std::vector<VkResult> results;
  bool layers = true;  ///< may watch
};

constexpr VkResult kHost = VK_ERROR_OUT_OF_HOST_MEMORY;
constexpr VkResult kDevice = VK_ERROR_OUT_OF_DEVICE_MEMORY;
constexpr VkResult kLost = VK_ERROR_DEVICE_LOST;
constexpr VkResult kUnready = VK_ERROR_INITIALIZATION_FAILED;

/// As the specification of Vulkan 1.3 has them, VK_ERROR_UNKNOWN once.
const std::vector<Fallible>& fallible() {
  static const std::vector<Fallible> all = {
      {"vkCreateInstance", {kHost, kDevice, kUnready, VK_ERROR_INCOMPATIBLE_DRIVER}, false},
      {"vkEnumeratePhysicalDevices", {kHost, kDevice, kUnready}, false},
      {"vkEnumerateDeviceExtensionProperties", {kHost, kDevice}, false},
      {"vkCreateDevice",
       {kHost, kDevice, kUnready, kLost, VK_ERROR_EXTENSION_NOT_PRESENT,
        VK_ERROR_FEATURE_NOT_PRESENT, VK_ERROR_TOO_MANY_OBJECTS, VK_ERROR_UNKNOWN}},
      {"vkAllocateCommandBuffers", {kHost, kDevice}},
      {"vkAllocateDescriptorSets",
       {kHost, kDevice, VK_ERROR_FRAGMENTED_POOL, VK_ERROR_OUT_OF_POOL_MEMORY}},
      {"vkAllocateMemory", {kHost, kDevice}},
      {"vkBeginCommandBuffer", {kHost, kDevice}},
      {"vkBindBufferMemory", {kHost, kDevice}},
      {"vkCreateBuffer", {kHost, kDevice}},
      {"vkCreateBufferView", {kHost, kDevice}},
      {"vkCreateCommandPool", {kHost, kDevice}},
      {"vkCreateComputePipelines", {kHost, kDevice}},
      {"vkCreateDescriptorPool", {kHost, kDevice, VK_ERROR_FRAGMENTATION}},
      {"vkCreateDescriptorSetLayout", {kHost, kDevice}},
      {"vkCreateFence", {kHost, kDevice}},
      {"vkCreatePipelineCache", {kHost, kDevice}},
      {"vkCreatePipelineLayout", {kHost, kDevice}},
      {"vkCreateQueryPool", {kHost, kDevice}},
      {"vkCreateShaderModule", {kHost, kDevice}},
      {"vkEndCommandBuffer", {kHost, kDevice}},
      {"vkFlushMappedMemoryRanges", {kHost, kDevice}},
      {"vkGetPipelineCacheData", {kHost, kDevice}},
      {"vkGetQueryPoolResults", {kHost, kDevice, kLost, VK_NOT_READY}},
      {"vkInvalidateMappedMemoryRanges", {kHost, kDevice}},
      {"vkMapMemory", {kHost, kDevice, VK_ERROR_MEMORY_MAP_FAILED}},
      {"vkMergePipelineCaches", {kHost, kDevice}},
      {"vkQueueSubmit", {kHost, kDevice, kLost}},
      {"vkResetFences", {kHost, kDevice}},
      {"vkWaitForFences", {kHost, kDevice, kLost, VK_TIMEOUT}},
  };
  return all;
}

/// Of what fails below an instance always samples: where a driver lists its devices once and then
/// no more, the loader 1.3.239 reads memory that is not there.
std::set<long> numbers(long calls, Thoroughly how, bool below_instance) {
  std::set<long> chosen;
  if (std::getenv("FLOWDLO_LONG_TESTS") != nullptr && !below_instance) {
    for (long n = 1; n <= calls; ++n) chosen.insert(n);
  } else if (how == Thoroughly::kFirstAlone) {
    chosen = {1};
  } else {
    chosen = {1, (calls + 1) / 2, calls};
  }
  return chosen;
}

}  // namespace

void walk(const Action& once, Thoroughly how, bool may_differ, const std::set<std::string>& only) {
  const auto action = [&](bool layers) {  // as in a process of its own
    vulkan::forget_findings();
    auto outcome = once(layers);
    vulkan::forget_drivers();
    return outcome;
  };
  std::map<std::string, long> calls;
  std::string expected;
  for (const bool layers : {false, true}) {
    const auto warm = action(layers);
    ASSERT_TRUE(warm) << warm.error().message;
    relay()->reset();
    const auto before = action(layers);
    ASSERT_TRUE(before) << before.error().message;
    expected = *before;
    for (const Fallible& one : fallible()) {
      if (one.layers == layers) calls[one.function] = relay()->calls(one.function);
    }
  }

  std::map<std::string, long> codes;
  long failures = 0;
  int functions = 0;
  for (const auto& [function, results, layers] : fallible()) {
    if (calls[function] == 0 || !(only.empty() || only.count(function) > 0)) continue;
    ++functions;
    for (const long number : numbers(calls[function], how, !layers)) {
      for (const VkResult result : results) {
        SCOPED_TRACE(std::string(function) + ", call " + std::to_string(number) + " of " +
                     std::to_string(calls[function]) + ": " + vulkan::name_of(result));
        relay()->fail(function, number, result);
        const auto start = std::chrono::steady_clock::now();
        const auto got = action(layers);
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
        EXPECT_TRUE(relay()->failed()) << "that call never came";
        ++failures;
        ++codes[got ? "right" : name_of(got.error().code)];
        EXPECT_LT(took.count(), 60) << "it all but hung";
        EXPECT_EQ(relay()->alive(), 0) << "objects of Vulkan are left";
        if (got) {
          EXPECT_TRUE(may_differ || *got == expected);
          continue;
        }
        EXPECT_NE(got.error().code, ErrorCode::kInternal) << got.error().message;
        EXPECT_FALSE(got.error().message.empty());
      }
    }
    relay()->reset();
    const auto after = action(layers);
    ASSERT_TRUE(after) << function << ": " << after.error().message;
    EXPECT_TRUE(*after == expected) << "after " << function;
  }
  std::cout << "[ walk     ] " << functions << " functions, " << failures << " failures";
  for (const auto& [code, count] : codes) std::cout << ", " << count << " " << code;
  std::cout << std::endl;
}

}  // namespace flowdlo::testing
