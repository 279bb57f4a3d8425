#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string_view>
#include <vector>

#include "support/relay.hpp"
#include "vulkan/vulkan_api.hpp"

namespace flowdlo::testing {
namespace {

#define RELAY_ID(name) k_##name,
enum Function : int {
  kCreateInstance,
  FLOWDLO_INSTANCE_FUNCTIONS(RELAY_ID) FLOWDLO_DEVICE_FUNCTIONS(RELAY_ID) kCount
};
#undef RELAY_ID

#define RELAY_NAME(name) #name,
constexpr std::array<const char*, kCount> kNames = {"vkCreateInstance",
                                                    FLOWDLO_INSTANCE_FUNCTIONS(RELAY_NAME)
                                                        FLOWDLO_DEVICE_FUNCTIONS(RELAY_NAME)};
#undef RELAY_NAME

struct State {
  std::mutex mutex;
  std::array<long, kCount> calls{};
  int fault_in = -1;  // a Function
  long fault_at = 0;  // counted down
  VkResult fault = VK_SUCCESS;
  bool failed = false;
  bool lost = false;
  std::atomic<long> alive = 0;
  std::atomic<bool> poses_as_gpu = false;
  std::atomic<bool> hides = false;
  RelayLimits limits;  // set while nobody calls
};

State& state() {
  static State one;
  return one;
}

bool notices_loss(int function) {
  return function == k_vkQueueSubmit || function == k_vkWaitForFences ||
         function == k_vkGetQueryPoolResults;
}

/// Counts a call. VK_SUCCESS: it goes on to the other driver.
VkResult met(int function) {
  State& now = state();
  const std::lock_guard lock(now.mutex);
  ++now.calls[static_cast<std::size_t>(function)];
  if (function == now.fault_in && --now.fault_at == 0) {
    now.failed = true;
    now.lost = now.fault == VK_ERROR_DEVICE_LOST && function != k_vkCreateDevice;
    return now.fault;
  }
  return now.lost && notices_loss(function) ? VK_ERROR_DEVICE_LOST : VK_SUCCESS;
}

template <class Handle>
void born(const Handle* handles, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) {
    if (handles[i] != VK_NULL_HANDLE) ++state().alive;
  }
}

/// What a call of each shape does to the number of objects.
template <class... Arguments>
void count_objects(Arguments...) {}

template <class Info, class Handle>
void count_objects(VkDevice, const Info*, const VkAllocationCallbacks*, Handle* created) {
  born(created, 1);
}
void count_objects(VkPhysicalDevice, const VkDeviceCreateInfo*, const VkAllocationCallbacks*,
                   VkDevice* created) {
  born(created, 1);
  const std::lock_guard lock(state().mutex);
  state().lost = false;
}
void count_objects(const VkInstanceCreateInfo*, const VkAllocationCallbacks*, VkInstance* created) {
  born(created, 1);
}
void count_objects(VkDevice, VkPipelineCache, std::uint32_t count,
                   const VkComputePipelineCreateInfo*, const VkAllocationCallbacks*,
                   VkPipeline* created) {
  born(created, count);
}
template <class Handle>
void count_objects(VkDevice, Handle object, const VkAllocationCallbacks*) {
  if (object != VK_NULL_HANDLE) --state().alive;
}
void count_objects(VkDevice device, const VkAllocationCallbacks*) {
  if (device != VK_NULL_HANDLE) --state().alive;
}
void count_objects(VkInstance instance, const VkAllocationCallbacks*) {
  if (instance != VK_NULL_HANDLE) --state().alive;
}

template <int kFunction, class Pointer>
struct Relayed;

template <int kFunction, class... Arguments>
struct Relayed<kFunction, VkResult(VKAPI_PTR*)(Arguments...)> {
  static inline VkResult(VKAPI_PTR* next)(Arguments...) = nullptr;
  static VKAPI_ATTR VkResult VKAPI_CALL call(Arguments... arguments) {
    const VkResult fault = met(kFunction);
    if (fault == VK_ERROR_DEVICE_LOST && kFunction == k_vkWaitForFences) {
      (void)next(arguments...);  // what a lost device did is over
    }
    if (fault != VK_SUCCESS) return fault;
    const VkResult result = next(arguments...);
    if (result == VK_SUCCESS) count_objects(arguments...);
    return result;
  }
};

template <int kFunction, class... Arguments>
struct Relayed<kFunction, void(VKAPI_PTR*)(Arguments...)> {
  static inline void(VKAPI_PTR* next)(Arguments...) = nullptr;
  static VKAPI_ATTR void VKAPI_CALL call(Arguments... arguments) {
    (void)met(kFunction);
    count_objects(arguments...);
    next(arguments...);
  }
};

template <int kFunction, class... Arguments>
struct Relayed<kFunction, PFN_vkVoidFunction(VKAPI_PTR*)(Arguments...)> {
  static inline PFN_vkVoidFunction(VKAPI_PTR* next)(Arguments...) = nullptr;
  static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL call(Arguments... arguments) {
    return next(arguments...);
  }
};

using CreateInstance = Relayed<kCreateInstance, PFN_vkCreateInstance>;
using GetDeviceProcAddr = Relayed<k_vkGetDeviceProcAddr, PFN_vkGetDeviceProcAddr>;
using ListDevices = Relayed<k_vkEnumeratePhysicalDevices, PFN_vkEnumeratePhysicalDevices>;
using Properties = Relayed<k_vkGetPhysicalDeviceProperties, PFN_vkGetPhysicalDeviceProperties>;
using Features2 = Relayed<k_vkGetPhysicalDeviceFeatures2, PFN_vkGetPhysicalDeviceFeatures2>;
using FormatProperties =
    Relayed<k_vkGetPhysicalDeviceFormatProperties, PFN_vkGetPhysicalDeviceFormatProperties>;
using Properties2 = Relayed<k_vkGetPhysicalDeviceProperties2, PFN_vkGetPhysicalDeviceProperties2>;

VKAPI_ATTR VkResult VKAPI_CALL list_devices(VkInstance instance, std::uint32_t* count,
                                            VkPhysicalDevice* devices) {
  if (!state().hides) return ListDevices::call(instance, count, devices);
  *count = 0;
  return VK_SUCCESS;
}

void clamp(std::uint32_t& value, std::uint32_t limit) {
  if (limit != 0) value = std::min(value, limit);
}

void pose(VkPhysicalDeviceProperties& properties) {
  const RelayLimits& asked = state().limits;
  VkPhysicalDeviceLimits& limits = properties.limits;
  clamp(limits.maxComputeSharedMemorySize, asked.shared_bytes);
  clamp(limits.maxComputeWorkGroupInvocations, asked.invocations);
  for (std::uint32_t& size : limits.maxComputeWorkGroupSize) clamp(size, asked.invocations);
  clamp(limits.maxPushConstantsSize, asked.push_bytes);
  clamp(limits.maxTexelBufferElements, asked.texels);
  clamp(limits.maxPerStageDescriptorStorageBuffers, asked.storage_buffers);
  clamp(limits.maxDescriptorSetStorageBuffers, asked.storage_buffers);
  clamp(properties.apiVersion, asked.api_version);
  if (!state().poses_as_gpu) return;
  properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
  std::strncpy(properties.deviceName, "Relayed GPU", sizeof(properties.deviceName) - 1);
}

VKAPI_ATTR void VKAPI_CALL properties(VkPhysicalDevice device, VkPhysicalDeviceProperties* out) {
  Properties::next(device, out);
  pose(*out);
}

/// Calls visit(part) of every structure of a chain that has this type.
template <class Part, class Visit>
void each_of(void* chain, VkStructureType type, const Visit& visit) {
  for (auto* part = static_cast<VkBaseOutStructure*>(chain); part != nullptr; part = part->pNext) {
    if (part->sType == type) visit(*reinterpret_cast<Part*>(part));
  }
}

VKAPI_ATTR void VKAPI_CALL properties_2(VkPhysicalDevice device, VkPhysicalDeviceProperties2* out) {
  Properties2::next(device, out);
  pose(out->properties);
  const RelayLimits& asked = state().limits;
  each_of<VkPhysicalDeviceDriverProperties>(
      out->pNext, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES, [](auto& driver) {
        if (state().poses_as_gpu) driver.driverID = VK_DRIVER_ID_AMD_PROPRIETARY;
      });
  const auto limit_operations = [&](VkSubgroupFeatureFlags& operations, std::uint32_t& size) {
    if (!asked.shuffles) operations = VK_SUBGROUP_FEATURE_BASIC_BIT;
    if (asked.subgroup_size != 0) size = asked.subgroup_size;
  };
  each_of<VkPhysicalDeviceSubgroupProperties>(
      out->pNext, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES, [&](auto& subgroup) {
        limit_operations(subgroup.supportedOperations, subgroup.subgroupSize);
      });
  each_of<VkPhysicalDeviceSubgroupSizeControlProperties>(
      out->pNext, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_PROPERTIES,
      [&](auto& sizes) {
        if (asked.least_lanes != 0) sizes.minSubgroupSize = asked.least_lanes;
        if (asked.most_lanes != 0) sizes.maxSubgroupSize = asked.most_lanes;
      });
  each_of<VkPhysicalDeviceVulkan11Properties>(
      out->pNext, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES,
      [&](auto& all) { limit_operations(all.subgroupSupportedOperations, all.subgroupSize); });
}

VKAPI_ATTR void VKAPI_CALL features_2(VkPhysicalDevice device, VkPhysicalDeviceFeatures2* out) {
  Features2::next(device, out);
  if (state().limits.size_control) return;
  each_of<VkPhysicalDeviceSubgroupSizeControlFeatures>(
      out->pNext, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_FEATURES,
      [](auto& control) { control.subgroupSizeControl = control.computeFullSubgroups = VK_FALSE; });
}

VKAPI_ATTR void VKAPI_CALL format_properties(VkPhysicalDevice device, VkFormat format,
                                             VkFormatProperties* out) {
  FormatProperties::next(device, format, out);
  if (state().limits.float_texels || format != VK_FORMAT_R32G32B32A32_SFLOAT) return;
  out->bufferFeatures &=
      ~static_cast<VkFormatFeatureFlags>(VK_FORMAT_FEATURE_UNIFORM_TEXEL_BUFFER_BIT);
}

using Memory =
    Relayed<k_vkGetPhysicalDeviceMemoryProperties, PFN_vkGetPhysicalDeviceMemoryProperties>;
using Requirements = Relayed<k_vkGetBufferMemoryRequirements, PFN_vkGetBufferMemoryRequirements>;
using Allocate = Relayed<k_vkAllocateMemory, PFN_vkAllocateMemory>;

constexpr std::uint32_t kTheirMemory = 0;  // the one type that lavapipe has

VKAPI_ATTR void VKAPI_CALL memory(VkPhysicalDevice device, VkPhysicalDeviceMemoryProperties* out) {
  Memory::next(device, out);
  if (!state().limits.memory_apart) return;
  out->memoryTypeCount = 2;
  out->memoryTypes[0] = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
  out->memoryTypes[1] = {VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_CACHED_BIT,
                         0};
}

VKAPI_ATTR void VKAPI_CALL requirements(VkDevice device, VkBuffer buffer,
                                        VkMemoryRequirements* out) {
  Requirements::call(device, buffer, out);
  if (state().limits.memory_apart) out->memoryTypeBits = 0b11;
}

VKAPI_ATTR VkResult VKAPI_CALL allocate(VkDevice device, const VkMemoryAllocateInfo* info,
                                        const VkAllocationCallbacks* allocation,
                                        VkDeviceMemory* out) {
  VkMemoryAllocateInfo theirs = *info;
  if (state().limits.memory_apart) theirs.memoryTypeIndex = kTheirMemory;
  return Allocate::call(device, &theirs, allocation, out);
}

using Extensions =
    Relayed<k_vkEnumerateDeviceExtensionProperties, PFN_vkEnumerateDeviceExtensionProperties>;
using CreateDevice = Relayed<k_vkCreateDevice, PFN_vkCreateDevice>;

constexpr const char* kPortabilitySubset = "VK_KHR_portability_subset";

VKAPI_ATTR VkResult VKAPI_CALL extensions(VkPhysicalDevice device, const char* layer,
                                          std::uint32_t* count, VkExtensionProperties* out) {
  if (!state().limits.portability) return Extensions::call(device, layer, count, out);
  const std::uint32_t room = *count;
  if (out != nullptr) {
    if (room == 0) return VK_INCOMPLETE;
    --*count;
  }
  const VkResult result = Extensions::call(device, layer, count, out);
  if (result < VK_SUCCESS) return result;
  if (out != nullptr) {
    VkExtensionProperties own{};
    std::strncpy(own.extensionName, kPortabilitySubset, sizeof(own.extensionName) - 1);
    own.specVersion = 1;
    out[*count] = own;
  }
  ++*count;
  return result;
}

/// The other driver knows nothing of a subset of Vulkan. One that has it must be asked for it.
VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical,
                                             const VkDeviceCreateInfo* info,
                                             const VkAllocationCallbacks* allocation,
                                             VkDevice* device) {
  if (!state().limits.portability) return CreateDevice::call(physical, info, allocation, device);
  std::vector<const char*> others;
  for (std::uint32_t i = 0; i < info->enabledExtensionCount; ++i) {
    const char* const name = info->ppEnabledExtensionNames[i];
    if (std::strcmp(name, kPortabilitySubset) != 0) others.push_back(name);
  }
  if (others.size() == info->enabledExtensionCount) return VK_ERROR_INITIALIZATION_FAILED;
  VkDeviceCreateInfo rest = *info;
  rest.enabledExtensionCount = static_cast<std::uint32_t>(others.size());
  rest.ppEnabledExtensionNames = others.data();
  return CreateDevice::call(physical, &rest, allocation, device);
}

/// Ours in the place of `theirs`, where this relay minds the function.
PFN_vkVoidFunction relayed(std::string_view name, PFN_vkVoidFunction theirs);

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_proc_addr(VkDevice device, const char* name) {
  return relayed(name, GetDeviceProcAddr::next(device, name));
}

template <class Kind, class Pointer>
PFN_vkVoidFunction put_between(PFN_vkVoidFunction theirs, Pointer ours) {
  Kind::next = reinterpret_cast<decltype(Kind::next)>(theirs);
  return reinterpret_cast<PFN_vkVoidFunction>(ours);
}

template <class Kind>
PFN_vkVoidFunction put_between(PFN_vkVoidFunction theirs) {
  return put_between<Kind>(theirs, &Kind::call);
}

PFN_vkVoidFunction relayed(std::string_view name, PFN_vkVoidFunction theirs) {
  if (theirs == nullptr) return nullptr;
  if (name == "vkGetDeviceProcAddr") {
    return put_between<GetDeviceProcAddr>(theirs, &get_device_proc_addr);
  }
  if (name == "vkEnumeratePhysicalDevices") return put_between<ListDevices>(theirs, &list_devices);
  if (name == "vkGetPhysicalDeviceProperties") return put_between<Properties>(theirs, &properties);
  if (name == "vkGetPhysicalDeviceProperties2" || name == "vkGetPhysicalDeviceProperties2KHR") {
    return put_between<Properties2>(theirs, &properties_2);
  }
  if (name == "vkGetPhysicalDeviceFeatures2") return put_between<Features2>(theirs, &features_2);
  if (name == "vkGetPhysicalDeviceFormatProperties") {
    return put_between<FormatProperties>(theirs, &format_properties);
  }
  if (name == "vkGetPhysicalDeviceMemoryProperties") return put_between<Memory>(theirs, &memory);
  if (name == "vkGetBufferMemoryRequirements") {
    return put_between<Requirements>(theirs, &requirements);
  }
  if (name == "vkAllocateMemory") return put_between<Allocate>(theirs, &allocate);
  if (name == "vkEnumerateDeviceExtensionProperties") {
    return put_between<Extensions>(theirs, &extensions);
  }
  if (name == "vkCreateDevice") return put_between<CreateDevice>(theirs, &create_device);
  if (name == "vkCreateInstance") return put_between<CreateInstance>(theirs);
#define RELAY_PUT(function) \
  if (name == #function) return put_between<Relayed<k_##function, PFN_##function>>(theirs);
  FLOWDLO_INSTANCE_FUNCTIONS(RELAY_PUT)
  FLOWDLO_DEVICE_FUNCTIONS(RELAY_PUT)
#undef RELAY_PUT
  return theirs;
}

/// The other driver; without one nothing here works, and the test says so.
void* other() {
  static void* const library = [] {
    const char* const name = std::getenv("RELAY_TARGET");
    return name != nullptr ? dlopen(name, RTLD_LAZY | RTLD_LOCAL) : nullptr;
  }();
  return library;
}

int function_of(const char* name) {
  for (int i = 0; i < kCount; ++i) {
    if (std::strcmp(kNames[static_cast<std::size_t>(i)], name) == 0) return i;
  }
  std::abort();  // a test's mistake
}

}  // namespace
}  // namespace flowdlo::testing

using namespace flowdlo::testing;

extern "C" {

__attribute__((visibility("default"))) VkResult vk_icdNegotiateLoaderICDInterfaceVersion(
    std::uint32_t* version) {
  if (other() == nullptr) return VK_ERROR_INCOMPATIBLE_DRIVER;
  using Negotiate = VkResult (*)(std::uint32_t*);
  return reinterpret_cast<Negotiate>(dlsym(other(), "vk_icdNegotiateLoaderICDInterfaceVersion"))(
      version);
}

__attribute__((visibility("default"))) PFN_vkVoidFunction vk_icdGetInstanceProcAddr(
    VkInstance instance, const char* name) {
  static const auto next =
      reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(other(), "vk_icdGetInstanceProcAddr"));
  return relayed(name, next(instance, name));
}

__attribute__((visibility("default"))) const RelayTable* relay() {
  static constexpr RelayTable table{
      .reset =
          [] {
            const std::lock_guard lock(state().mutex);
            state().calls.fill(0);
            state().fault_in = -1;
            state().failed = state().lost = false;
          },
      .fail =
          [](const char* function, long nth, std::int32_t result) {
            const std::lock_guard lock(state().mutex);
            state().fault_in = function_of(function);
            state().fault_at = nth;
            state().fault = static_cast<VkResult>(result);
            state().failed = state().lost = false;
          },
      .failed =
          [] {
            const std::lock_guard lock(state().mutex);
            return state().failed;
          },
      .lost =
          [] {
            const std::lock_guard lock(state().mutex);
            return state().lost || (state().failed && state().fault_in == k_vkQueueSubmit);
          },
      .calls =
          [](const char* function) {
            const std::lock_guard lock(state().mutex);
            return state().calls[static_cast<std::size_t>(function_of(function))];
          },
      .alive = [] { return state().alive.load(); },
      .pose_as_gpu = [](bool poses) { state().poses_as_gpu = poses; },
      .limit = [](const RelayLimits& limits) { state().limits = limits; },
      .hide = [](bool hides) { state().hides = hides; },
  };
  return &table;
}
}
