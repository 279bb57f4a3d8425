// The public <flowdlo/vulkan.hpp>, and the device that it hands over.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "vulkan/vulkan_api.hpp"
// Behind it, for that says that Vulkan's functions have no prototypes.
#include "flowdlo/vulkan.hpp"
#include "guard/guarded.hpp"
#include "vulkan/backend.hpp"
#include "vulkan/cooperative_matrix.hpp"
#include "vulkan/device.hpp"

namespace flowdlo::vulkan {
namespace {

/// One fault a line.
class Faults {
 public:
  void expect(bool fine, std::string_view fault) {
    if (fine) return;
    text_ += fmt::format("{}VulkanHost.{}", text_.empty() ? "" : "\n", fault);
  }
  [[nodiscard]] bool any() const { return !text_.empty(); }
  [[nodiscard]] Error error() const { return {ErrorCode::kBadInput, text_}; }

 private:
  std::string text_;
};

Faults faults_of_instance(const VulkanHost& host) {
  Faults faults;
  faults.expect(host.get_instance_proc_addr != nullptr,
                "get_instance_proc_addr: expected the loader's vkGetInstanceProcAddr, got null");
  faults.expect(host.instance != VK_NULL_HANDLE, "instance: expected a VkInstance, got null");
  faults.expect(host.physical_device != VK_NULL_HANDLE,
                "physical_device: expected a VkPhysicalDevice, got null");
  faults.expect(
      host.api_version >= VK_API_VERSION_1_1,
      fmt::format("api_version: expected an instance of Vulkan 1.1 or later, got {}; raise "
                  "VkApplicationInfo::apiVersion",
                  version_text(host.api_version)));
  return faults;
}

Faults faults_of(const VulkanHost& host) {
  Faults faults = faults_of_instance(host);
  faults.expect(host.device != VK_NULL_HANDLE, "device: expected a VkDevice, got null");
  faults.expect((host.lock == nullptr) == (host.unlock == nullptr),
                "lock, unlock: expected both or neither, got one");
  if (host.allocation != nullptr) {
    const VkAllocationCallbacks& given = *host.allocation;
    faults.expect(given.pfnAllocation != nullptr && given.pfnReallocation != nullptr &&
                      given.pfnFree != nullptr,
                  "allocation: expected pfnAllocation, pfnReallocation and pfnFree, got null among "
                  "them");
  }
  return faults;
}

bool has_timelines(const Instance& instance, VkPhysicalDevice device, std::uint32_t version) {
  if (version < VK_API_VERSION_1_2 &&
      !has_extension(instance.api(), device, VK_KHR_TIMELINE_SEMAPHORE_EXTENSION_NAME)) {
    return false;
  }
  VkPhysicalDeviceTimelineSemaphoreFeatures timelines{};
  timelines.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES;
  VkPhysicalDeviceFeatures2 features{};
  features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  features.pNext = &timelines;
  instance.api().vkGetPhysicalDeviceFeatures2(device, &features);
  return timelines.timelineSemaphore == VK_TRUE;
}

/// The version that both the instance and the device have.
std::uint32_t shared_version(const Instance& instance, const VulkanHost& host) {
  VkPhysicalDeviceProperties properties{};
  instance.api().vkGetPhysicalDeviceProperties(host.physical_device, &properties);
  return std::min(properties.apiVersion, host.api_version);
}

VulkanNeeds needs_of(const Instance& instance, const VulkanHost& host) {
  const PhysicalDevice device = describe(instance, host.physical_device);
  VulkanNeeds needs;
  needs.lacks = device.report.lacks;
  const std::uint32_t version = shared_version(instance, host);
  if (version < VK_API_VERSION_1_1) return needs;  // nothing more can be asked
  needs.required.portability_subset = device.portability;
  needs.wanted = {.subgroup_size_control = device.fixes_lanes,
                  .compute_full_subgroups = device.full_subgroups,
                  .cooperative_matrix = device.matrix_edge > 0,
                  .timeline_semaphore = has_timelines(instance, host.physical_device, version),
                  .portability_subset = device.portability,
                  .debug_utils = false};
  const auto add = [&](bool wanted, const char* extension, std::uint32_t taken_in) {
    if (wanted && version < taken_in) needs.extensions.push_back(extension);
  };
  constexpr std::uint32_t kNever = UINT32_MAX;
  add(device.portability, kPortabilitySubset, kNever);
  add(device.fixes_lanes, VK_EXT_SUBGROUP_SIZE_CONTROL_EXTENSION_NAME, VK_API_VERSION_1_3);
  add(needs.wanted.timeline_semaphore, VK_KHR_TIMELINE_SEMAPHORE_EXTENSION_NAME,
      VK_API_VERSION_1_2);
  for (const char* const extension : kMatrixExtensions) {
    add(device.matrix_edge > 0, extension,
        extension == kCooperativeMatrixExtension ? kNever : VK_API_VERSION_1_2);
  }
  const auto families = queue_families(instance.api(), host.physical_device);
  for (std::uint32_t i = 0; i < families.size(); ++i) {
    if ((families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) != 0) needs.queue_families.push_back(i);
  }
  return needs;
}

Error refusal(const PhysicalDevice& device) {
  std::string text;
  for (const std::string& lack : device.report.lacks) {
    text += fmt::format("{}{}", text.empty() ? "" : ", ", lack);
  }
  return {
      ErrorCode::kNoDevice,
      fmt::format("VulkanHost.device: expected a device that FlowDLO can run on, got \"{}\", which "
                  "lacks {}; make it as vulkan_needs() says, or leave the device to FlowDLO",
                  device.report.name, text)};
}

}  // namespace

Result<std::shared_ptr<Device>> adopt_device(const VulkanHost& host) {
  const Faults faults = faults_of(host);
  if (faults.any()) return faults.error();
  auto instance =
      Instance::borrow(host.get_instance_proc_addr, host.instance, host.enabled.debug_utils);
  if (!instance) return instance.error();
  PhysicalDevice physical = describe(**instance, host.physical_device,
                                     {.size_control = host.enabled.subgroup_size_control,
                                      .full_subgroups = host.enabled.compute_full_subgroups,
                                      .matrices = host.enabled.cooperative_matrix,
                                      .queue_family = host.queue_family});
  if (physical.portability && !host.enabled.portability_subset) {
    physical.report.lacks.push_back(fmt::format(
        "{} among its extensions (VulkanHost.enabled.portability_subset)", kPortabilitySubset));
  }
  if (!physical.report.lacks.empty()) return refusal(physical);
  Lent lent{.device = host.device,
            .queue_index = host.queue_index,
            .lock = host.lock,
            .unlock = host.unlock,
            .user = host.user,
            .timeline = host.enabled.timeline_semaphore};
  if (host.allocation != nullptr) lent.allocation = *host.allocation;
  return Device::adopt(*std::move(instance), physical, lent);
}

}  // namespace flowdlo::vulkan

namespace flowdlo {

Result<VulkanNeeds> vulkan_needs(const VulkanHost& host) {
  return guard::guarded("vulkan_needs", [&]() -> Result<VulkanNeeds> {
    const vulkan::Faults faults = vulkan::faults_of_instance(host);
    if (faults.any()) return faults.error();
    const auto instance =
        vulkan::Instance::borrow(host.get_instance_proc_addr, host.instance, /*debug=*/false);
    if (!instance) return instance.error();
    return vulkan::needs_of(**instance, host);
  });
}

}  // namespace flowdlo
