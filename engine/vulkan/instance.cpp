#include "vulkan/instance.hpp"

#include <algorithm>
#include <exception>
#include <optional>
#include <string_view>

#include "vulkan/absence.hpp"
#include "vulkan/check.hpp"

namespace flowdlo::vulkan {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr std::string_view kNoDeviceYet = "instance";

/// Held while an instance comes or goes, and drivers with it: NVIDIA's may crash where several
/// threads do that at once. Never destroyed: a device may outlive what the process ends with.
std::mutex& coming_and_going() {
  static auto* const mutex = new std::mutex();
  return *mutex;
}

/// The version of Vulkan that the validation layer was made for.
std::optional<std::uint32_t> validation_layer(const Loader& loader) {
  const auto enumerate = reinterpret_cast<PFN_vkEnumerateInstanceLayerProperties>(
      loader.find(VK_NULL_HANDLE, "vkEnumerateInstanceLayerProperties"));
  std::uint32_t count = 0;
  if (enumerate == nullptr || enumerate(&count, nullptr) != VK_SUCCESS) return std::nullopt;
  std::vector<VkLayerProperties> layers(count);
  if (enumerate(&count, layers.data()) < VK_SUCCESS) return std::nullopt;
  const auto found = std::find_if(layers.begin(), layers.end(), [](const auto& layer) {
    return std::string_view(layer.layerName) == kValidationLayer;
  });
  return found == layers.end() ? std::nullopt : std::optional(found->specVersion);
}

/// Whether devices of which only a subset of Vulkan is there (MoltenVK's) must be asked for.
bool hides_portable_devices(const Loader& loader) {
  const auto enumerate = reinterpret_cast<PFN_vkEnumerateInstanceExtensionProperties>(
      loader.find(VK_NULL_HANDLE, "vkEnumerateInstanceExtensionProperties"));
  std::uint32_t count = 0;
  if (enumerate == nullptr || enumerate(nullptr, &count, nullptr) != VK_SUCCESS) return false;
  std::vector<VkExtensionProperties> extensions(count);
  if (enumerate(nullptr, &count, extensions.data()) < VK_SUCCESS) return false;
  return std::any_of(extensions.begin(), extensions.end(), [](const auto& extension) {
    return std::string_view(extension.extensionName) ==
           VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME;
  });
}

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                          VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data,
                                          void* log) {
  try {
    static_cast<MessageLog*>(log)->add(data->pMessage != nullptr ? data->pMessage : "");
  } catch (const std::exception&) {  // no memory for it; the driver would not survive the throw
  }
  return VK_FALSE;
}

}  // namespace

Result<void> Instance::load_functions(bool debug) {
#define FLOWDLO_LOAD(function)                                                         \
  api_.function = reinterpret_cast<PFN_##function>(loader_->find(handle_, #function)); \
  if (api_.function == nullptr) {                                                      \
    return Error{ErrorCode::kNoDevice, "Vulkan loader: expected " #function            \
                                       ", found none; "                                \
                                       "update libvulkan1"};                           \
  }
  FLOWDLO_INSTANCE_FUNCTIONS(FLOWDLO_LOAD)
#undef FLOWDLO_LOAD
  if (!debug) return {};
  api_.vkCreateDebugUtilsMessengerEXT = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
      loader_->find(handle_, "vkCreateDebugUtilsMessengerEXT"));
  api_.vkDestroyDebugUtilsMessengerEXT = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
      loader_->find(handle_, "vkDestroyDebugUtilsMessengerEXT"));
  api_.vkSetDebugUtilsObjectNameEXT = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(
      loader_->find(handle_, "vkSetDebugUtilsObjectNameEXT"));
  return {};
}

Result<void> Instance::listen() {
  if (api_.vkCreateDebugUtilsMessengerEXT == nullptr) return {};
  const VkDebugUtilsMessengerCreateInfoEXT info{
      .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
      .pNext = nullptr,
      .flags = 0,
      .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                         VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
      .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
      .pfnUserCallback = on_message,
      .pUserData = log_.get()};
  return check(api_.vkCreateDebugUtilsMessengerEXT(handle_, &info, nullptr, &messenger_),
               "vkCreateDebugUtilsMessengerEXT", kNoDeviceYet);
}

Instance::~Instance() {
  if (messenger_ != VK_NULL_HANDLE) {
    api_.vkDestroyDebugUtilsMessengerEXT(handle_, messenger_, nullptr);
  }
  if (owned_ && handle_ != VK_NULL_HANDLE && api_.vkDestroyInstance != nullptr) {
    const std::lock_guard lock(coming_and_going());
    api_.vkDestroyInstance(handle_, nullptr);
  }
}

Result<std::unique_ptr<Instance>> Instance::create(std::shared_ptr<const Loader> loader,
                                                   bool validation) {
  std::unique_ptr<Instance> instance(new Instance(std::move(loader)));
  const std::lock_guard lock(coming_and_going());
  const Loader& from = instance->loader();
  const auto layer = validation ? validation_layer(from) : std::nullopt;
  const bool layered = layer.has_value();
  std::vector<const char*> extensions;
  if (layered) {
    extensions = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
  }
  const bool portable = hides_portable_devices(from);
  if (portable) extensions.push_back(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
  const VkValidationFeatureEnableEXT synchronization =
      VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  const VkValidationFeaturesEXT features{.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                         .pNext = nullptr,
                                         .enabledValidationFeatureCount = 1,
                                         .pEnabledValidationFeatures = &synchronization,
                                         .disabledValidationFeatureCount = 0,
                                         .pDisabledValidationFeatures = nullptr};
  const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                      .pNext = nullptr,
                                      .pApplicationName = nullptr,
                                      .applicationVersion = 0,
                                      .pEngineName = "flowdlo",
                                      .engineVersion = 0,
                                      .apiVersion = VK_API_VERSION_1_1};
  VkInstanceCreateFlags flags = 0;
  if (portable) flags |= VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR;
  const VkInstanceCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
      .pNext = layered ? &features : nullptr,
      .flags = flags,
      .pApplicationInfo = &application,
      .enabledLayerCount = layered ? 1U : 0U,
      .ppEnabledLayerNames = &kValidationLayer,
      .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
      .ppEnabledExtensionNames = extensions.data()};
  const auto create =
      reinterpret_cast<PFN_vkCreateInstance>(from.find(VK_NULL_HANDLE, "vkCreateInstance"));
  if (create == nullptr) {
    return Error{ErrorCode::kNoDevice,
                 "Vulkan loader: expected vkCreateInstance, found none; update libvulkan1"};
  }
  const VkResult result = create(&info, nullptr, &instance->handle_);
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER) return no_driver();
  const auto created = check(result, "vkCreateInstance", kNoDeviceYet);
  if (!created) return created.error();
  const auto loaded = instance->load_functions(layered);
  if (!loaded) return loaded.error();
  if (layered) {
    instance->layer_version_ = *layer;
    const auto heard = instance->listen();
    if (!heard) return heard.error();
  }
  return instance;
}

Result<std::unique_ptr<Instance>> Instance::borrow(PFN_vkGetInstanceProcAddr get, VkInstance handle,
                                                   bool debug) {
  std::unique_ptr<Instance> instance(new Instance(Loader::of_host(get)));
  instance->owned_ = false;
  instance->handle_ = handle;
  const auto loaded = instance->load_functions(debug);
  if (loaded) return instance;
  return Error{ErrorCode::kBadInput,
               "VulkanHost.get_instance_proc_addr: " + loaded.error().message};
}

}  // namespace flowdlo::vulkan
