#include "vulkan/device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "threads/team.hpp"
#include "vulkan/cooperative_matrix.hpp"
#include "vulkan/kept_drivers.hpp"

namespace flowdlo::vulkan {
namespace {

constexpr int kMostCompilers = 8;  // threads

/// Compiles all specs with a few threads; results stand in the order of `specs`.
std::vector<Result<Kernel>> compile(const Device& device, const std::vector<KernelSpec>& specs) {
  std::vector<std::optional<Result<Kernel>>> results(specs.size());
  std::atomic<std::size_t> next = 0;
  const int compilers =
      std::min({static_cast<int>(specs.size()), kMostCompilers, threads::cores()});
  threads::work_together(std::max(compilers, 1), [&](int) {
    for (std::size_t i = next++; i < specs.size(); i = next++) {
      results[i].emplace(Kernel::create(device, specs[i]));
    }
  });

  std::vector<Result<Kernel>> kernels;
  for (auto& result : results) kernels.push_back(*std::move(result));
  return kernels;
}

std::string_view kind_name(VkObjectType type) {
  switch (type) {
    case VK_OBJECT_TYPE_BUFFER:
      return "vkCreateBuffer";
    case VK_OBJECT_TYPE_BUFFER_VIEW:
      return "vkCreateBufferView";
    case VK_OBJECT_TYPE_COMMAND_POOL:
      return "vkCreateCommandPool";
    case VK_OBJECT_TYPE_DESCRIPTOR_POOL:
      return "vkCreateDescriptorPool";
    case VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT:
      return "vkCreateDescriptorSetLayout";
    case VK_OBJECT_TYPE_FENCE:
      return "vkCreateFence";
    case VK_OBJECT_TYPE_PIPELINE_CACHE:
      return "vkCreatePipelineCache";
    case VK_OBJECT_TYPE_PIPELINE_LAYOUT:
      return "vkCreatePipelineLayout";
    case VK_OBJECT_TYPE_QUERY_POOL:
      return "vkCreateQueryPool";
    case VK_OBJECT_TYPE_SHADER_MODULE:
      return "vkCreateShaderModule";
    default:
      return "vkCreate";
  }
}

}  // namespace

Error Device::failed(VkResult result, VkObjectType type, std::string_view name) const {
  return check(result, fmt::format("{}({})", kind_name(type), name)).error();
}

void Device::name_object(VkObjectType type, std::uint64_t object, const std::string& name) const {
  if (instance_->api().vkSetDebugUtilsObjectNameEXT == nullptr) return;
  const VkDebugUtilsObjectNameInfoEXT info{
      .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
      .pNext = nullptr,
      .objectType = type,
      .objectHandle = object,
      .pObjectName = name.c_str()};
  instance_->api().vkSetDebugUtilsObjectNameEXT(handle_, &info);
}

Result<void> Device::create_device() {
  const float priority = 1.0F;
  const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                      .pNext = nullptr,
                                      .flags = 0,
                                      .queueFamilyIndex = facts_.queue_family,
                                      .queueCount = 1,
                                      .pQueuePriorities = &priority};
  VkPhysicalDeviceSubgroupSizeControlFeaturesEXT control{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_FEATURES_EXT,
      .pNext = nullptr,
      .subgroupSizeControl = VK_TRUE,
      .computeFullSubgroups = facts_.full_subgroups ? VK_TRUE : VK_FALSE};
  void* chain = nullptr;
  std::vector<const char*> extensions;
  if (facts_.portability) extensions.push_back(kPortabilitySubset);
  if (facts_.fixes_lanes) {
    chain = &control;
    extensions.push_back(VK_EXT_SUBGROUP_SIZE_CONTROL_EXTENSION_NAME);
  }
  MatrixFeatures matrices;
  matrices.matrix.cooperativeMatrix = VK_TRUE;
  matrices.arithmetic.shaderFloat16 = VK_TRUE;
  matrices.memory.vulkanMemoryModel = VK_TRUE;
  if (facts_.matrix_edge > 0) {
    chain = matrices.chain(chain);
    extensions.insert(extensions.end(), kMatrixExtensions.begin(), kMatrixExtensions.end());
  }
  VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR,
      .pNext = chain,
      .pipelineExecutableInfo = VK_TRUE};
  if (facts_.keeps_statistics) {
    chain = &statistics;
    extensions.push_back(VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
  }
  const VkDeviceCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
      .pNext = chain,
      .flags = 0,
      .queueCreateInfoCount = 1,
      .pQueueCreateInfos = &queue,
      .enabledLayerCount = 0,
      .ppEnabledLayerNames = nullptr,
      .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
      .ppEnabledExtensionNames = extensions.data(),
      .pEnabledFeatures = nullptr};
  return check(instance_->api().vkCreateDevice(facts_.handle, &info, nullptr, &handle_),
               "vkCreateDevice");
}

Result<void> Device::load_functions() {
#define FLOWDLO_LOAD(function)                                                                    \
  api_.function =                                                                                 \
      reinterpret_cast<PFN_##function>(instance_->api().vkGetDeviceProcAddr(handle_, #function)); \
  if (api_.function == nullptr) {                                                                 \
    return Error{ErrorCode::kNoDevice,                                                            \
                 fmt::format("\"{}\": expected " #function ", found none; update its driver",     \
                             facts_.report.name)};                                                \
  }
  FLOWDLO_DEVICE_FUNCTIONS(FLOWDLO_LOAD)
#undef FLOWDLO_LOAD
  return {};
}

Device::~Device() {
  kernels_.clear();
  pipeline_cache_ = {};
  if (!lent_ && handle_ != VK_NULL_HANDLE && api_.vkDestroyDevice != nullptr) {
    api_.vkDestroyDevice(handle_, nullptr);
  }
}

Result<void> Device::submit(VkCommandBuffer commands, VkFence fence, const Meeting& meeting) {
  const auto count = [](const Moments& moments) {
    return static_cast<std::uint32_t>(moments.semaphores.size());
  };
  const std::vector<VkPipelineStageFlags> stages(meeting.waits.semaphores.size(),
                                                 commands != VK_NULL_HANDLE
                                                     ? VK_PIPELINE_STAGE_TRANSFER_BIT
                                                     : VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT);
  const VkTimelineSemaphoreSubmitInfo values{
      .sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
      .pNext = nullptr,
      .waitSemaphoreValueCount = count(meeting.waits),
      .pWaitSemaphoreValues = meeting.waits.values.data(),
      .signalSemaphoreValueCount = count(meeting.signals),
      .pSignalSemaphoreValues = meeting.signals.values.data()};
  const bool meets = count(meeting.waits) + count(meeting.signals) > 0;
  const VkSubmitInfo info{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                          .pNext = meets ? &values : nullptr,
                          .waitSemaphoreCount = count(meeting.waits),
                          .pWaitSemaphores = meeting.waits.semaphores.data(),
                          .pWaitDstStageMask = stages.data(),
                          .commandBufferCount = commands != VK_NULL_HANDLE ? 1U : 0U,
                          .pCommandBuffers = &commands,
                          .signalSemaphoreCount = count(meeting.signals),
                          .pSignalSemaphores = meeting.signals.semaphores.data()};
  const std::lock_guard lock(queue_mutex_);
  ++submits_;
  const bool locks = lent_ && lent_->lock != nullptr;
  if (locks) lent_->lock(lent_->user);
  const VkResult submitted = api_.vkQueueSubmit(queue_, 1, &info, fence);
  if (locks) lent_->unlock(lent_->user);
  return check(submitted, "vkQueueSubmit");
}

Result<std::vector<const Kernel*>> Device::kernels(std::span<const KernelSpec> specs,
                                                   int* compiled) {
  const std::lock_guard lock(kernels_mutex_);
  std::vector<KernelSpec> missing;
  for (const KernelSpec& spec : specs) {
    const std::string name = spec.name();
    const bool listed = std::any_of(missing.begin(), missing.end(),
                                    [&](const KernelSpec& other) { return other.name() == name; });
    if (!listed && kernels_.find(name) == kernels_.end()) missing.push_back(spec);
  }
  std::vector<Result<Kernel>> made = compile(*this, missing);
  for (std::size_t i = 0; i < missing.size(); ++i) {
    if (!made[i]) return made[i].error();
    kernels_.emplace(missing[i].name(), *std::move(made[i]));
  }
  if (compiled != nullptr) *compiled = static_cast<int>(missing.size());
  std::vector<const Kernel*> kernels;
  for (const KernelSpec& spec : specs) kernels.push_back(&kernels_.find(spec.name())->second);
  return kernels;
}

Result<void> Device::complete(std::uint32_t queue_index) {
  const auto loaded = load_functions();
  if (!loaded) return loaded.error();
  api_.vkGetDeviceQueue(handle_, facts_.queue_family, queue_index, &queue_);
  const VkPipelineCacheCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                       .pNext = nullptr,
                                       .flags = 0,
                                       .initialDataSize = 0,
                                       .pInitialData = nullptr};
  auto cache = create(api_.vkCreatePipelineCache, api_.vkDestroyPipelineCache, info,
                      VK_OBJECT_TYPE_PIPELINE_CACHE, "kernels");
  if (!cache) return cache.error();
  pipeline_cache_ = *std::move(cache);
  return {};
}

Result<std::shared_ptr<Device>> Device::open(std::unique_ptr<Instance> instance,
                                             const PhysicalDevice& physical) {
  std::shared_ptr<Device> device(new Device(std::move(instance), physical));
  const auto created = device->create_device();
  if (!created) return created.error();
  if (physical.report.kind != DeviceKind::kCpu) {
    keep_driver(physical.driver_uuid, device->instance_);
  }
  const auto completed = device->complete(0);
  if (!completed) return completed.error();
  return device;
}

Result<std::shared_ptr<Device>> Device::adopt(std::unique_ptr<Instance> instance,
                                              const PhysicalDevice& physical, const Lent& lent) {
  std::shared_ptr<Device> device(new Device(std::move(instance), physical));
  device->lent_ = lent;
  device->handle_ = lent.device;
  const auto completed = device->complete(lent.queue_index);
  if (!completed) return completed.error();
  return device;
}

}  // namespace flowdlo::vulkan
