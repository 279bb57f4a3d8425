// PhysicalDevice: what a device is, what it can do, and what FlowDLO misses on it.
#pragma once

#include <cstdint>
#include <string>
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
};

/// In the loader's order.
[[nodiscard]] std::vector<PhysicalDevice> physical_devices(const Instance& instance);

}  // namespace flowdlo::vulkan
