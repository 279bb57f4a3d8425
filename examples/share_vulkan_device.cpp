// share_vulkan_device FRAME: FlowDLO on a Vulkan device of the program's own, and a frame whose
// depth and mask lie in a buffer of that device.
#include <vulkan/vulkan.h>

#include <cstring>
#include <flowdlo/flowdlo.hpp>
#include <flowdlo/vulkan.hpp>
#include <iostream>
#include <mutex>

namespace {

/// Vulkan's answers that a real program would look at one by one.
void must(VkResult result) {
  if (result == VK_SUCCESS) return;
  std::cerr << "Vulkan: VkResult " << result << '\n';
  std::exit(1);
}

template <class Value>
auto must(flowdlo::Result<Value> result) {
  if (result) return *std::move(result);
  std::cerr << result.error().message << '\n';
  std::exit(1);
}

/// What this program does with Vulkan anyway: memory that it has mapped, with a buffer over it.
struct MappedBuffer {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  char* bytes = nullptr;

  MappedBuffer(VkPhysicalDevice physical, VkDevice device, VkDeviceSize size) {
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = size;
    info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT;  // FlowDLO copies from it
    must(vkCreateBuffer(device, &info, nullptr, &buffer));
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device, buffer, &needs);
    VkPhysicalDeviceMemoryProperties types;
    vkGetPhysicalDeviceMemoryProperties(physical, &types);
    constexpr auto kWanted =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    VkMemoryAllocateInfo allocation{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocation.allocationSize = needs.size;
    auto& type = allocation.memoryTypeIndex;  // Vulkan promises that there is one
    while ((needs.memoryTypeBits >> type & 1U) == 0 ||
           (types.memoryTypes[type].propertyFlags & kWanted) != kWanted) {
      ++type;
    }
    must(vkAllocateMemory(device, &allocation, nullptr, &memory));
    must(vkBindBufferMemory(device, buffer, memory, 0));
    void* address = nullptr;
    must(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &address));
    bytes = static_cast<char*>(address);
  }
};

}  // namespace

int main(int argc, char** argv) {
  const auto folder = must(flowdlo::load_frame_folder(argc > 1 ? argv[1] : "."));
  const flowdlo::Frame image = folder.frame();

  // 1. The program's instance, and the device that it picks.
  flowdlo::VulkanHost host;
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.apiVersion = host.api_version = VK_API_VERSION_1_2;
  VkInstanceCreateInfo instance_info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  instance_info.pApplicationInfo = &application;
  must(vkCreateInstance(&instance_info, nullptr, &host.instance));
  std::uint32_t count = 1;
  if (vkEnumeratePhysicalDevices(host.instance, &count, &host.physical_device) < 0 || count == 0) {
    std::cerr << "no Vulkan device\n";
    return 1;
  }

  // 2. What FlowDLO would have the device made with.
  host.get_instance_proc_addr = vkGetInstanceProcAddr;
  const auto needs = must(flowdlo::vulkan_needs(host));
  for (const auto& lack : needs.lacks) std::cerr << "the device lacks " << lack << '\n';
  if (!needs.lacks.empty()) return 1;
  host.queue_family = needs.queue_families.front();
  host.enabled = needs.wanted;
  host.enabled.cooperative_matrix = false;  // may be left out, as all but `required`

  // 3. The device, with these features beside the program's own.
  VkPhysicalDeviceSubgroupSizeControlFeatures sizes{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_FEATURES};
  sizes.subgroupSizeControl = host.enabled.subgroup_size_control;
  sizes.computeFullSubgroups = host.enabled.compute_full_subgroups;
  VkPhysicalDeviceTimelineSemaphoreFeatures timelines{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES};
  timelines.timelineSemaphore = host.enabled.timeline_semaphore;
  void* features = nullptr;
  if (host.enabled.subgroup_size_control) features = &sizes;
  if (host.enabled.timeline_semaphore) {
    timelines.pNext = features;
    features = &timelines;
  }
  std::vector<const char*> extensions;
  for (const char* extension : needs.extensions) {
    if (std::strstr(extension, "cooperative_matrix") == nullptr) extensions.push_back(extension);
  }
  const float priority = 1.0F;
  VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue.queueFamilyIndex = host.queue_family;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkDeviceCreateInfo device_info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, features};
  device_info.queueCreateInfoCount = 1;
  device_info.pQueueCreateInfos = &queue;
  device_info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  device_info.ppEnabledExtensionNames = extensions.data();
  must(vkCreateDevice(host.physical_device, &device_info, nullptr, &host.device));

  // 4. One lock for the queue, which every other use of it in this program takes as well.
  std::mutex queue_mutex;
  host.user = &queue_mutex;
  host.lock = [](void* mutex) { static_cast<std::mutex*>(mutex)->lock(); };
  host.unlock = [](void* mutex) { static_cast<std::mutex*>(mutex)->unlock(); };

  // 5. Depth and mask in a buffer, as the program's own kernels would leave them there.
  const MappedBuffer buffer(host.physical_device, host.device,
                            image.depth_m.size_bytes() + image.mask.size_bytes());
  std::memcpy(buffer.bytes, image.depth_m.data(), image.depth_m.size_bytes());
  std::memcpy(buffer.bytes + image.depth_m.size_bytes(), image.mask.data(), image.mask.size());
  flowdlo::VulkanFrame frame;
  frame.width = image.width;
  frame.height = image.height;
  frame.intrinsics = image.intrinsics;
  frame.depth_m = {buffer.buffer, 0};
  frame.mask = {buffer.buffer, image.depth_m.size_bytes()};
  // frame.waits and frame.signals: timeline semaphores of whoever fills the buffer.

  {  // 6. The estimator ends before the device.
    auto estimator = must(flowdlo::Estimator::create({}, host));
    const auto estimate = must(estimator.estimate(frame));
    for (const auto& node : estimate.nodes) {
      std::cout << node.x << ' ' << node.y << ' ' << node.z << '\n';
    }
    std::cerr << "confidence " << estimate.confidence << " on " << estimator.device() << '\n';
  }
  vkDestroyBuffer(host.device, buffer.buffer, nullptr);
  vkFreeMemory(host.device, buffer.memory, nullptr);
  vkDestroyDevice(host.device, nullptr);
  vkDestroyInstance(host.instance, nullptr);
}
