// VulkanHost: a program that has a VkDevice already lets FlowDLO run on it. The only header that
// needs Vulkan's own (Debian: libvulkan-dev); <flowdlo/flowdlo.hpp> leaves it out. A program that
// takes Vulkan's functions from a loader of its own (volk) includes that first, or defines
// VK_NO_PROTOTYPES. A library that was built without Vulkan comes without this header.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "flowdlo/export.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo {

/// Features of a VkDevice that FlowDLO makes use of. One is there where it was enabled when the
/// device was made, together with its extension, or in a version of Vulkan that has taken it in.
struct VulkanFeatures {
  /// VK_EXT_subgroup_size_control or Vulkan 1.3; subgroupSizeControl of
  /// VkPhysicalDeviceSubgroupSizeControlFeatures or VkPhysicalDeviceVulkan13Features.
  bool subgroup_size_control = false;
  /// The same structure's computeFullSubgroups.
  bool compute_full_subgroups = false;
  /// VK_KHR_cooperative_matrix: cooperativeMatrix; with it VK_KHR_shader_float16_int8:
  /// shaderFloat16, and VK_KHR_vulkan_memory_model: vulkanMemoryModel, or both of Vulkan 1.2.
  bool cooperative_matrix = false;
  /// VK_KHR_timeline_semaphore or Vulkan 1.2; timelineSemaphore of
  /// VkPhysicalDeviceTimelineSemaphoreFeatures or VkPhysicalDeviceVulkan12Features.
  bool timeline_semaphore = false;
  /// VK_KHR_portability_subset, the extension alone: none of its features is used.
  bool portability_subset = false;
  /// The instance's VK_EXT_debug_utils: FlowDLO's objects then have names.
  bool debug_utils = false;
};

/// A device that a program made, and one of its queues. Plain values, copied by whoever is given
/// them; what they point to stays the host's.
///
/// **What the device must have been created with.** An instance of Vulkan 1.1 or later; a queue
/// without VkDeviceQueueCreateFlags, of a family with compute; VK_KHR_portability_subset where the
/// device has it. No feature of VkPhysicalDeviceFeatures is needed, and any may be enabled. What
/// `enabled` has beyond that makes kernels faster on GPUs: with every feature that vulkan_needs()
/// calls wanted FlowDLO runs, to the bit, as on a device of its own; without, results may differ
/// in rounding. timeline_semaphore is for VulkanFrame alone. Of what is lacking, Estimator::create
/// fails with kNoDevice and names it.
///
/// **Who owns what.** FlowDLO makes objects of its own on the device (memory, buffers, pipelines,
/// descriptor, query and command pools, a pipeline cache, fences) and destroys them with the
/// estimator. The instance, the device, the queue, and a VulkanFrame's buffers and semaphores are
/// never destroyed here, a lost device's neither. Estimators go first, then the host's device; any
/// number of them may share one.
///
/// **Threads.** FlowDLO calls vkQueueSubmit alone of all that needs the queue to itself, in
/// Estimator::create and in each call of an estimator; on the caller's thread, or on one of its own
/// while the caller waits. Each submission stands between `lock` and `unlock`, which must not
/// throw; nothing is waited for between them, and they are never nested. The host takes the same
/// lock for all its own uses of the queue, vkDeviceWaitIdle among them. Without lock and unlock
/// nobody else may use the queue as long as a call of FlowDLO lasts.
struct VulkanHost {
  PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;  ///< the loader's or the host's own
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  std::uint32_t queue_family = 0;  ///< has compute
  std::uint32_t queue_index = 0;   ///< below the number that the device was made with
  /// VkApplicationInfo::apiVersion of the instance.
  std::uint32_t api_version = VK_API_VERSION_1_1;
  VulkanFeatures enabled;  ///< what the device does not have is taken for not enabled

  void (*lock)(void* user) = nullptr;  ///< both, or neither
  void (*unlock)(void* user) = nullptr;
  void* user = nullptr;  ///< handed to lock and unlock

  /// For all that FlowDLO makes on the device; called from several threads at once. Null: the
  /// driver's own.
  const VkAllocationCallbacks* allocation = nullptr;
};

/// How a device is to be made so that FlowDLO can run on it.
struct VulkanNeeds {
  VulkanFeatures required;  ///< without these there is no estimator
  VulkanFeatures wanted;    ///< all of the above, and what else the device has to offer
  /// Of the features wanted, for VkDeviceCreateInfo; without those that `api_version` has taken in.
  /// They last as long as the process.
  std::vector<const char*> extensions;
  std::vector<std::uint32_t> queue_families;  ///< with compute; of any of them one queue is enough
  std::vector<std::string>
      lacks;  ///< what the device has not, whatever it is made with; else empty
};

/// Asks before there is a device: of `host` only get_instance_proc_addr, instance, physical_device
/// and api_version are read. Fails with kBadInput, naming what is missing of these.
[[nodiscard]] FLOWDLO_EXPORT Result<VulkanNeeds> vulkan_needs(const VulkanHost& host);

/// An image in a buffer of the host's device: rows without padding. The buffer was made with
/// VK_BUFFER_USAGE_TRANSFER_SRC_BIT, and belongs to the queue's family or is shared with it.
struct VulkanImage {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceSize offset = 0;  ///< bytes; any
};

/// A timeline semaphore of the host's device, and a value of it.
struct VulkanMoment {
  VkSemaphore semaphore = VK_NULL_HANDLE;
  std::uint64_t value = 0;
};

/// A Frame whose depth and mask lie in buffers of the host's device.
///
/// The rope's path is found on the processor, so depth and mask are read back: they are copied to
/// memory of FlowDLO's own, by the host's queue, once all of `waits` have come; then `signals`
/// come, and the buffers may be written again. Without `waits`, what was submitted to that queue
/// before is finished first. `signals` come once `waits` have, whatever error the call returns, but
/// where a semaphore is null; with kDeviceLost and kOutOfMemory they may not: the counters tell.
struct VulkanFrame {
  VulkanFrame() = default;  ///< so that estimate({.width = ...}) goes on to mean a Frame

  int width = 0;   ///< pixels, 1..4096
  int height = 0;  ///< pixels, 1..4096
  Intrinsics intrinsics;
  VulkanImage depth_m;                         ///< [height, width] float; as Frame::depth_m
  VulkanImage mask;                            ///< [height, width] bytes; as Frame::mask
  std::span<const std::uint8_t> color_bgr{};   ///< in the host's memory; as Frame::color_bgr
  std::span<const std::uint16_t> instances{};  ///< in the host's memory; as Frame::instances
  std::span<const VulkanMoment> waits{};
  std::span<const VulkanMoment> signals{};
};

}  // namespace flowdlo
