#include "vulkan/submission.hpp"

#include <fmt/format.h>

#include <chrono>
#include <thread>

namespace flowdlo::vulkan {
namespace {

std::uint64_t nanoseconds(int milliseconds) {
  return static_cast<std::uint64_t>(milliseconds > 0 ? milliseconds : 0) * 1'000'000U;
}

/// Whether work may still be under way after a wait that gave this: one that failed for want of
/// memory says nothing of it. A lost device runs nothing any more.
bool may_run_on(VkResult waited) { return waited != VK_SUCCESS && waited != VK_ERROR_DEVICE_LOST; }

}  // namespace

Result<Submission> Submission::create(const Device& device, bool again) {
  const VolkDeviceTable& api = device.api();
  Submission submission;
  const VkCommandPoolCreateFlags flags =
      again ? VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT : 0;
  const VkCommandPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .pNext = nullptr,
                                          .flags = flags,
                                          .queueFamilyIndex = device.facts().queue_family};
  auto pool = device.create(api.vkCreateCommandPool, api.vkDestroyCommandPool, pool_info,
                            VK_OBJECT_TYPE_COMMAND_POOL, "program");
  if (!pool) return pool.error();
  submission.pool_ = *std::move(pool);
  const VkFenceCreateInfo fence_info{
      .sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, .pNext = nullptr, .flags = 0};
  auto fence = device.create(api.vkCreateFence, api.vkDestroyFence, fence_info,
                             VK_OBJECT_TYPE_FENCE, "program");
  if (!fence) return fence.error();
  submission.fence_ = *std::move(fence);
  return submission;
}

Result<VkCommandBuffer> Submission::begin(const Device& device, std::string_view name) {
  const VkCommandBufferAllocateInfo allocation{
      .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
      .pNext = nullptr,
      .commandPool = pool_.get(),
      .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
      .commandBufferCount = 1};
  VkCommandBuffer commands = VK_NULL_HANDLE;
  const auto allocated =
      device.check(device.api().vkAllocateCommandBuffers(device.handle(), &allocation, &commands),
                   fmt::format("vkAllocateCommandBuffers({})", name));
  if (!allocated) return allocated.error();
  device.name(VK_OBJECT_TYPE_COMMAND_BUFFER, commands, name);
  const auto begun = begin_again(device, commands);
  if (!begun) return begun.error();
  return commands;
}

Result<void> Submission::begin_again(const Device& device, VkCommandBuffer commands) {
  const VkCommandBufferBeginInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                      .pNext = nullptr,
                                      .flags = 0,
                                      .pInheritanceInfo = nullptr};
  return device.check(device.api().vkBeginCommandBuffer(commands, &info), "vkBeginCommandBuffer");
}

Result<void> Submission::end(const Device& device, VkCommandBuffer commands) {
  return device.check(device.api().vkEndCommandBuffer(commands), "vkEndCommandBuffer");
}

Result<void> Submission::run(Device& device, VkCommandBuffer commands, int timeout_ms,
                             const Meeting& meeting) {
  const VkFence fence = fence_.get();
  const auto reset =
      device.check(device.api().vkResetFences(device.handle(), 1, &fence), "vkResetFences");
  if (!reset) return reset.error();
  const auto submitted = device.submit(commands, fence, meeting);
  if (!submitted) return submitted.error();
  in_flight_ = true;
  const VkResult waited =
      device.api().vkWaitForFences(device.handle(), 1, &fence, VK_TRUE, nanoseconds(timeout_ms));
  if (waited == VK_TIMEOUT) {
    return Error{ErrorCode::kDeviceLost,
                 fmt::format("\"{}\": expected a result within {} ms, got none; create anew, "
                             "perhaps with a longer timeout or on another device",
                             device.facts().report.name, timeout_ms)};
  }
  in_flight_ = may_run_on(waited);
  return device.check(waited, "vkWaitForFences");
}

bool Submission::idle(const Device& device, int wait_ms) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kPause{10};
  const auto by = Clock::now() + std::chrono::milliseconds(wait_ms);
  const VkFence fence = fence_.get();
  while (in_flight_) {
    const VkResult waited =
        device.api().vkWaitForFences(device.handle(), 1, &fence, VK_TRUE, nanoseconds(wait_ms));
    in_flight_ = may_run_on(waited);
    if (waited == VK_TIMEOUT || Clock::now() >= by) break;
    if (in_flight_) std::this_thread::sleep_for(kPause);
  }
  return !in_flight_;
}

}  // namespace flowdlo::vulkan
