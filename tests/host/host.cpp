#include "host/host.hpp"

#include <algorithm>
#include <cstring>
#include <iostream>
#include <string_view>

namespace flowdlo::testing {
namespace {

constexpr const char* kLayer = "VK_LAYER_KHRONOS_validation";

bool failed(VkResult result, const char* what) {
  if (result == VK_SUCCESS) return false;
  std::cout << "[ host     ] " << what << ": VkResult " << result << std::endl;
  return true;
}

bool has_layer() {
  std::uint32_t count = 0;
  vkEnumerateInstanceLayerProperties(&count, nullptr);
  std::vector<VkLayerProperties> layers(count);
  vkEnumerateInstanceLayerProperties(&count, layers.data());
  return std::any_of(layers.begin(), layers.end(), [](const VkLayerProperties& layer) {
    return std::string_view(layer.layerName) == kLayer;
  });
}

bool has_instance_extension(std::string_view name) {
  std::uint32_t count = 0;
  vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> extensions(count);
  vkEnumerateInstanceExtensionProperties(nullptr, &count, extensions.data());
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const auto& extension) { return name == extension.extensionName; });
}

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                          VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data,
                                          void* user) {
  auto* const heard = static_cast<Heard*>(user);
  const std::lock_guard lock(heard->mutex);
  heard->messages.emplace_back(data->pMessage);
  return VK_FALSE;
}

}  // namespace

bool Host::make_instance(const Wishes& wishes) {
  const bool layered = wishes.layers && has_layer();
  std::vector<const char*> extensions;
  VkInstanceCreateFlags flags = 0;
  if (layered) {
    extensions = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
  }
  if (has_instance_extension(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME)) {
    extensions.push_back(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
    flags |= VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR;
  }
  const VkValidationFeatureEnableEXT synchronization =
      VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  VkValidationFeaturesEXT features{};
  features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
  features.enabledValidationFeatureCount = 1;
  features.pEnabledValidationFeatures = &synchronization;
  VkDebugUtilsMessengerCreateInfoEXT listening{};
  listening.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
  listening.pNext = &features;
  listening.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                              VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  listening.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  listening.pfnUserCallback = on_message;
  listening.pUserData = heard_.get();
  VkApplicationInfo application{};
  application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  application.apiVersion = api_version_ = wishes.api_version;
  VkInstanceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  info.pNext = layered ? &listening : nullptr;  // so that vkDestroyInstance is watched too
  info.flags = flags;
  info.pApplicationInfo = &application;
  info.enabledLayerCount = layered ? 1 : 0;
  info.ppEnabledLayerNames = &kLayer;
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  if (failed(vkCreateInstance(&info, nullptr, &instance_), "vkCreateInstance")) return false;
  if (!layered) return true;
  listening.pNext = nullptr;
  enabled_.debug_utils = true;
  const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
  return !failed(create(instance_, &listening, nullptr, &messenger_), "messenger");
}

bool Host::make_device(const Wishes& wishes) {
  std::uint32_t count = 1;
  if (vkEnumeratePhysicalDevices(instance_, &count, &physical_) < VK_SUCCESS || count == 0) {
    std::cout << "[ host     ] no Vulkan device" << std::endl;
    return false;
  }
  const auto needs = vulkan_needs(handed_over());
  if (needs) needs_ = *needs;
  std::uint32_t families_count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical_, &families_count, nullptr);
  std::vector<VkQueueFamilyProperties> families(families_count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical_, &families_count, families.data());
  constexpr VkQueueFlags kBoth = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  while (family_ < families_count && (families[family_].queueFlags & kBoth) != kBoth) ++family_;
  if (family_ == families_count) return false;

  const VulkanFeatures& wanted = wishes.features ? needs_.wanted : needs_.required;
  const bool debug = enabled_.debug_utils;
  enabled_ = wanted;
  enabled_.debug_utils = debug;
  VkPhysicalDeviceSubgroupSizeControlFeatures sizes{};
  sizes.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_FEATURES;
  sizes.subgroupSizeControl = wanted.subgroup_size_control ? VK_TRUE : VK_FALSE;
  sizes.computeFullSubgroups = wanted.compute_full_subgroups ? VK_TRUE : VK_FALSE;
  VkPhysicalDeviceTimelineSemaphoreFeatures timelines{};
  timelines.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES;
  timelines.timelineSemaphore = wanted.timeline_semaphore ? VK_TRUE : VK_FALSE;
  enabled_.cooperative_matrix = false;  // a host need not enable all
  void* chain = nullptr;
  const auto link = [&](bool use, auto& structure) {
    if (!use) return;
    structure.pNext = chain;
    chain = &structure;
  };
  link(wanted.subgroup_size_control, sizes);
  link(wanted.timeline_semaphore, timelines);
  std::vector<const char*> extensions;
  for (const char* const extension : needs_.extensions) {
    const bool of_matrices = std::string_view(extension).find("matrix") != std::string_view::npos;
    const bool portability = std::string_view(extension) == "VK_KHR_portability_subset";
    if (portability ? wanted.portability_subset : wishes.features && !of_matrices) {
      extensions.push_back(extension);
    }
  }
  const float priority = 1.0F;
  VkDeviceQueueCreateInfo queue{};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueFamilyIndex = family_;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkDeviceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.pNext = chain;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  if (failed(vkCreateDevice(physical_, &info, nullptr, &device_), "vkCreateDevice")) return false;
  vkGetDeviceQueue(device_, family_, 0, &queue_);
  VkCommandPoolCreateInfo pool{};
  pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  pool.queueFamilyIndex = family_;
  return !failed(vkCreateCommandPool(device_, &pool, nullptr, &pool_), "vkCreateCommandPool");
}

std::unique_ptr<Host> Host::make(const Wishes& wishes) {
  std::unique_ptr<Host> host(new Host());
  if (!host->make_instance(wishes) || !host->make_device(wishes)) return nullptr;
  return host;
}

VulkanHost Host::handed_over() {
  VulkanHost host;
  host.get_instance_proc_addr = vkGetInstanceProcAddr;
  host.instance = instance_;
  host.physical_device = physical_;
  host.device = device_;
  host.queue_family = family_;
  host.api_version = api_version_;
  host.enabled = enabled_;
  host.lock = [](void* self) {
    static_cast<Host*>(self)->mutex_.lock();
    ++static_cast<Host*>(self)->times_locked_;
  };
  host.unlock = [](void* self) { static_cast<Host*>(self)->mutex_.unlock(); };
  host.user = this;
  return host;
}

VkResult Host::submit(const VkSubmitInfo& info) {
  const std::lock_guard lock(mutex_);
  return vkQueueSubmit(queue_, 1, &info, VK_NULL_HANDLE);
}

VkResult Host::submit_and_wait(const VkSubmitInfo& info) {
  VkFenceCreateInfo fence_info{};
  fence_info.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
  VkFence fence = VK_NULL_HANDLE;
  VkResult result = vkCreateFence(device_, &fence_info, nullptr, &fence);
  if (result != VK_SUCCESS) return result;
  {
    const std::lock_guard lock(mutex_);
    result = vkQueueSubmit(queue_, 1, &info, fence);
  }
  if (result == VK_SUCCESS) result = vkWaitForFences(device_, 1, &fence, VK_TRUE, UINT64_MAX);
  vkDestroyFence(device_, fence, nullptr);
  return result;
}

VkCommandBuffer Host::begin() {
  VkCommandBufferAllocateInfo allocation{};
  allocation.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  allocation.commandPool = pool_;
  allocation.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  if (failed(vkAllocateCommandBuffers(device_, &allocation, &commands), "commands")) return nullptr;
  VkCommandBufferBeginInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  return failed(vkBeginCommandBuffer(commands, &info), "begin") ? nullptr : commands;
}

std::uint32_t Host::memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const {
  VkPhysicalDeviceMemoryProperties memory{};
  vkGetPhysicalDeviceMemoryProperties(physical_, &memory);
  std::uint32_t type = 0;
  while ((allowed & (1U << type)) == 0 ||
         (memory.memoryTypes[type].propertyFlags & wanted) != wanted) {
    ++type;
  }
  return type;
}

Host::~Host() {
  if (device_ != VK_NULL_HANDLE) {
    vkDeviceWaitIdle(device_);
    vkDestroyCommandPool(device_, pool_, nullptr);
    vkDestroyDevice(device_, nullptr);
  }
  if (messenger_ != VK_NULL_HANDLE) {
    reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(
        instance_, "vkDestroyDebugUtilsMessengerEXT"))(instance_, messenger_, nullptr);
  }
  if (instance_ != VK_NULL_HANDLE) vkDestroyInstance(instance_, nullptr);
}

Timeline::Timeline(const Host& host) : device_(host.device()) {
  VkSemaphoreTypeCreateInfo type{};
  type.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO;
  type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
  VkSemaphoreCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
  info.pNext = &type;
  failed(vkCreateSemaphore(device_, &info, nullptr, &semaphore_), "vkCreateSemaphore");
}

Timeline::~Timeline() { vkDestroySemaphore(device_, semaphore_, nullptr); }

void Timeline::signal(std::uint64_t value) const {
  VkSemaphoreSignalInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO;
  info.semaphore = semaphore_;
  info.value = value;
  failed(vkSignalSemaphore(device_, &info), "vkSignalSemaphore");
}

std::uint64_t Timeline::value() const {
  std::uint64_t value = 0;
  failed(vkGetSemaphoreCounterValue(device_, semaphore_, &value), "vkGetSemaphoreCounterValue");
  return value;
}

bool Timeline::comes_to(std::uint64_t value) const {
  VkSemaphoreWaitInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO;
  info.semaphoreCount = 1;
  info.pSemaphores = &semaphore_;
  info.pValues = &value;
  return vkWaitSemaphores(device_, &info, 10'000'000'000ULL) == VK_SUCCESS;
}

HostBuffer::HostBuffer(const Host& host, VkDeviceSize bytes) : device_(host.device()) {
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = bytes;
  info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  failed(vkCreateBuffer(device_, &info, nullptr, &buffer_), "vkCreateBuffer");
  VkMemoryRequirements needs{};
  vkGetBufferMemoryRequirements(device_, buffer_, &needs);
  VkMemoryAllocateInfo allocation{};
  allocation.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  allocation.allocationSize = needs.size;
  allocation.memoryTypeIndex =
      host.memory_type(needs.memoryTypeBits,
                       VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  failed(vkAllocateMemory(device_, &allocation, nullptr, &memory_), "vkAllocateMemory");
  failed(vkBindBufferMemory(device_, buffer_, memory_, 0), "vkBindBufferMemory");
  void* address = nullptr;
  failed(vkMapMemory(device_, memory_, 0, VK_WHOLE_SIZE, 0, &address), "vkMapMemory");
  bytes_ = static_cast<std::uint8_t*>(address);
  std::memset(bytes_, 0, bytes);
}

HostBuffer::~HostBuffer() {
  vkDestroyBuffer(device_, buffer_, nullptr);
  vkFreeMemory(device_, memory_, nullptr);
}

}  // namespace flowdlo::testing
