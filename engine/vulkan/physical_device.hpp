// PhysicalDevice: what a device is, what it can do, and what FlowDLO misses on it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "flowdlo/devices.hpp"
#include "vulkan/instance.hpp"
#include "vulkan/vulkan_api.hpp"

namespace flowdlo::vulkan {

struct PhysicalDevice {
  VkPhysicalDevice handle = VK_NULL_HANDLE;
  DeviceReport report;  ///< `lacks` is empty where the device is usable
  VkPhysicalDeviceLimits limits{};
  VkPhysicalDeviceMemoryProperties memory{};
  std::uint32_t driver_version = 0;
  std::uint32_t queue_family = 0;    ///< has compute
  std::uint32_t timestamp_bits = 0;  ///< 0: no timestamps
  int lanes = 0;                ///< subgroup size in use, 4 to 128; without shuffles a workgroup's
  bool shuffles = true;         ///< between the lanes of a subgroup, in compute shaders
  bool fixes_lanes = false;     ///< by VK_EXT_subgroup_size_control
  bool full_subgroups = false;  ///< ditto
  /// Of cooperative matrices, f16 in and f32 out, by a subgroup: 16, 8, or 0 where there are none.
  int matrix_edge = 0;
  /// Whoever opens the device may set it: pipelines then keep what the driver's compiler says of
  /// them (VK_KHR_pipeline_executable_properties, which the driver must have).
  bool keeps_statistics = false;
  std::string driver_uuid;  ///< 32 hexadecimal digits
  bool portability = false;  ///< has VK_KHR_portability_subset, which must then be enabled
};

/// What may be made use of. Of a device that somebody else makes, what it was made with.
struct Allowed {
  bool size_control = true;  ///< of subgroups
  bool full_subgroups = true;
  bool matrices = true;
  std::optional<std::uint32_t> queue_family{};  ///< none: one of ours
};

[[nodiscard]] PhysicalDevice describe(const Instance& instance, VkPhysicalDevice handle,
                                      const Allowed& allowed = {});

[[nodiscard]] std::vector<VkQueueFamilyProperties> queue_families(const InstanceTable& api,
                                                                  VkPhysicalDevice device);

[[nodiscard]] bool has_extension(const InstanceTable& api, VkPhysicalDevice device,
                                 std::string_view name);

/// VK_KHR_portability_subset by its name, which headers have for beta platforms alone.
inline constexpr const char* kPortabilitySubset = "VK_KHR_portability_subset";

/// In the loader's order.
[[nodiscard]] std::vector<PhysicalDevice> physical_devices(const Instance& instance);

}  // namespace flowdlo::vulkan
