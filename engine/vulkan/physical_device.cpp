#include "vulkan/physical_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <string_view>

#include "vulkan/cooperative_matrix.hpp"

namespace flowdlo::vulkan {
namespace {

constexpr int kFewestLanes = 4;
constexpr int kMostLanes = 128;
constexpr std::uint32_t kGpuLanes = 32;  // where a GPU lets us choose
constexpr std::uint32_t kFewestPlainLanes = 8;
constexpr std::uint32_t kMostPlainLanes = 64;

DeviceKind kind_of(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return DeviceKind::kDiscreteGpu;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return DeviceKind::kIntegratedGpu;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return DeviceKind::kVirtualGpu;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return DeviceKind::kCpu;
    default:
      return DeviceKind::kOther;
  }
}

/// The family that is given. Otherwise the first with compute; one without graphics is preferred,
/// it is never shared with a UI.
void find_queue(const InstanceTable& api, PhysicalDevice& device, const Allowed& allowed) {
  const auto families = queue_families(api, device.handle);
  if (allowed.queue_family) {
    const std::uint32_t given = *allowed.queue_family;
    if (given >= families.size()) {
      device.report.lacks.push_back(
          fmt::format("queue family {} (has {})", given, families.size()));
    } else if ((families[given].queueFlags & VK_QUEUE_COMPUTE_BIT) == 0) {
      device.report.lacks.push_back(fmt::format("compute in queue family {}", given));
    } else {
      device.queue_family = given;
      device.timestamp_bits = families[given].timestampValidBits;
    }
    return;
  }
  std::optional<std::uint32_t> found;
  for (std::uint32_t i = 0; i < families.size(); ++i) {
    if ((families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) == 0) continue;
    const bool compute_alone = (families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) == 0;
    if (!found || (compute_alone && (families[*found].queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0)) {
      found = i;
    }
  }
  if (!found) {
    device.report.lacks.emplace_back("a compute queue");
    return;
  }
  device.queue_family = *found;
  device.timestamp_bits = families[*found].timestampValidBits;
}

void choose_lanes(const InstanceTable& api, PhysicalDevice& device,
                  const VkPhysicalDeviceSubgroupProperties& subgroup, const Allowed& allowed) {
  constexpr VkSubgroupFeatureFlags kNeeded =
      VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_SHUFFLE_BIT;
  std::uint32_t lanes = subgroup.subgroupSize;
  device.report.subgroup_size = static_cast<int>(lanes);
  device.shuffles = (subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0 &&
                    (subgroup.supportedOperations & kNeeded) == kNeeded;
  device.report.shuffles = device.shuffles;
  if (!device.shuffles) {  // plain kernels: any number does
    device.lanes = static_cast<int>(
        std::clamp(std::bit_ceil(std::max(lanes, 1U)), kFewestPlainLanes, kMostPlainLanes));
    return;
  }
  if (allowed.size_control &&
      has_extension(api, device.handle, VK_EXT_SUBGROUP_SIZE_CONTROL_EXTENSION_NAME)) {
    VkPhysicalDeviceSubgroupSizeControlPropertiesEXT sizes{};
    sizes.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_PROPERTIES_EXT;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &sizes;
    api.vkGetPhysicalDeviceProperties2(device.handle, &properties);
    VkPhysicalDeviceSubgroupSizeControlFeaturesEXT control{};
    control.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_FEATURES_EXT;
    VkPhysicalDeviceFeatures2 features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features.pNext = &control;
    api.vkGetPhysicalDeviceFeatures2(device.handle, &features);
    device.fixes_lanes = control.subgroupSizeControl == VK_TRUE &&
                         (sizes.requiredSubgroupSizeStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0;
    device.full_subgroups =
        allowed.full_subgroups && device.fixes_lanes && control.computeFullSubgroups == VK_TRUE;
    if (device.fixes_lanes && device.report.kind != DeviceKind::kCpu) {
      lanes = std::clamp(kGpuLanes, sizes.minSubgroupSize, sizes.maxSubgroupSize);
    }
  }
  device.lanes = static_cast<int>(lanes);
  device.report.subgroup_size = device.lanes;
  if (device.lanes < kFewestLanes || device.lanes > kMostLanes) {
    device.report.lacks.push_back(
        fmt::format("a subgroup of {} to {} lanes (has {})", kFewestLanes, kMostLanes, lanes));
  }
}

void look_for_texel_buffers(const InstanceTable& api, PhysicalDevice& device) {
  for (const auto& [format, name] : {std::pair{VK_FORMAT_R32G32B32A32_SFLOAT, "RGBA32F"},
                                     std::pair{VK_FORMAT_R32_SFLOAT, "R32F"}}) {
    VkFormatProperties properties{};
    api.vkGetPhysicalDeviceFormatProperties(device.handle, format, &properties);
    if ((properties.bufferFeatures & VK_FORMAT_FEATURE_UNIFORM_TEXEL_BUFFER_BIT) == 0) {
      device.report.lacks.push_back(fmt::format("uniform texel buffers of {}", name));
    }
  }
}

bool multiplies_halves(const CooperativeMatrixProperties& matrix, std::uint32_t edge) {
  return matrix.MSize == edge && matrix.NSize == edge && matrix.KSize == edge &&
         matrix.AType == MatrixComponent::kFloat16 && matrix.BType == MatrixComponent::kFloat16 &&
         matrix.CType == MatrixComponent::kFloat32 &&
         matrix.ResultType == MatrixComponent::kFloat32 &&
         matrix.saturatingAccumulation == VK_FALSE && matrix.scope == MatrixScope::kSubgroup;
}

/// Cooperative matrices, and what their shader needs beside them.
void look_for_matrices(const Instance& instance, PhysicalDevice& device) {
  if (!instance.may_use(kCooperativeMatrixVersion)) return;
  const InstanceTable& api = instance.api();
  for (const char* const extension : kMatrixExtensions) {
    if (!has_extension(api, device.handle, extension)) return;
  }
  MatrixFeatures offered;
  VkPhysicalDeviceFeatures2 features{};
  features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  features.pNext = offered.chain();
  api.vkGetPhysicalDeviceFeatures2(device.handle, &features);
  const auto list = reinterpret_cast<GetCooperativeMatrixProperties>(instance.loader().find(
      instance.handle(), "vkGetPhysicalDeviceCooperativeMatrixPropertiesKHR"));
  if (!offered.complete() || !device.full_subgroups || list == nullptr) return;
  std::uint32_t count = 0;
  if (list(device.handle, &count, nullptr) != VK_SUCCESS) return;
  std::vector<CooperativeMatrixProperties> matrices(count);
  if (list(device.handle, &count, matrices.data()) < VK_SUCCESS) return;
  for (const int edge : {8, 16}) {
    const auto has = [&](const auto& matrix) {
      return multiplies_halves(matrix, static_cast<std::uint32_t>(edge));
    };
    if (std::any_of(matrices.begin(), matrices.end(), has)) device.matrix_edge = edge;
  }
}

std::string hexadecimal(const std::uint8_t (&bytes)[VK_UUID_SIZE]) {
  std::string text;
  for (const std::uint8_t byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

}  // namespace

bool has_extension(const InstanceTable& api, VkPhysicalDevice device, std::string_view name) {
  std::uint32_t count = 0;
  if (api.vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr) != VK_SUCCESS) {
    return false;
  }
  std::vector<VkExtensionProperties> extensions(count);
  if (api.vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data()) <
      VK_SUCCESS) {
    return false;
  }
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const auto& extension) { return name == extension.extensionName; });
}

std::vector<VkQueueFamilyProperties> queue_families(const InstanceTable& api,
                                                    VkPhysicalDevice device) {
  std::uint32_t count = 0;
  api.vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  api.vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  families.resize(count);
  return families;
}

PhysicalDevice describe(const Instance& instance, VkPhysicalDevice handle, const Allowed& allowed) {
  const InstanceTable& api = instance.api();
  PhysicalDevice device;
  device.handle = handle;
  VkPhysicalDeviceProperties basic{};
  api.vkGetPhysicalDeviceProperties(handle, &basic);
  device.limits = basic.limits;
  device.driver_version = basic.driverVersion;
  device.report.name = basic.deviceName;
  device.report.kind = kind_of(basic.deviceType);
  device.report.api_version = version_text(basic.apiVersion);
  device.report.driver = fmt::format("{:#x}", basic.driverVersion);
  if (basic.apiVersion < VK_API_VERSION_1_1) {
    device.report.lacks.push_back(fmt::format("Vulkan 1.1 (has {})", device.report.api_version));
    return device;
  }

  VkPhysicalDeviceDriverPropertiesKHR driver{};
  driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES_KHR;
  VkPhysicalDeviceSubgroupProperties subgroup{};
  subgroup.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
  VkPhysicalDeviceIDProperties id{};
  id.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES;
  id.pNext = &subgroup;
  const bool names_driver = basic.apiVersion >= VK_API_VERSION_1_2 ||
                            has_extension(api, handle, VK_KHR_DRIVER_PROPERTIES_EXTENSION_NAME);
  if (names_driver) subgroup.pNext = &driver;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  properties.pNext = &id;
  api.vkGetPhysicalDeviceProperties2(handle, &properties);

  device.report.uuid = hexadecimal(id.deviceUUID);
  device.driver_uuid = hexadecimal(id.driverUUID);
  if (names_driver) {
    device.report.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
    if (driver.driverID == VK_DRIVER_ID_MESA_LLVMPIPE) device.report.kind = DeviceKind::kCpu;
  }
  api.vkGetPhysicalDeviceMemoryProperties(handle, &device.memory);
  device.portability = has_extension(api, handle, kPortabilitySubset);
  find_queue(api, device, allowed);
  choose_lanes(api, device, subgroup, allowed);
  look_for_texel_buffers(api, device);
  if (allowed.matrices) look_for_matrices(instance, device);
  return device;
}

std::vector<PhysicalDevice> physical_devices(const Instance& instance) {
  const InstanceTable& api = instance.api();
  std::uint32_t count = 0;
  if (api.vkEnumeratePhysicalDevices(instance.handle(), &count, nullptr) != VK_SUCCESS) return {};
  std::vector<VkPhysicalDevice> handles(count);
  if (api.vkEnumeratePhysicalDevices(instance.handle(), &count, handles.data()) < VK_SUCCESS) {
    return {};
  }
  std::vector<PhysicalDevice> devices;
  for (std::uint32_t i = 0; i < count; ++i) devices.push_back(describe(instance, handles[i]));
  return devices;
}

}  // namespace flowdlo::vulkan
