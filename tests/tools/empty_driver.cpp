// A Vulkan driver that finds no device, as a GPU's driver does on a machine without that GPU.
#include <cstdint>
#include <cstring>

namespace {

using Function = void (*)();
constexpr int kSuccess = 0;  // VK_SUCCESS
int instance = 0;            // what a VkInstance points at

int create_instance(const void*, const void*, void** created) {
  *created = &instance;
  return kSuccess;
}

int count_none(void*, std::uint32_t* count, void*) {
  *count = 0;
  return kSuccess;
}

int nothing() { return kSuccess; }

Function function_of(const char* name) {
  if (std::strcmp(name, "vkCreateInstance") == 0) {
    return reinterpret_cast<Function>(create_instance);
  }
  const bool lists = std::strcmp(name, "vkEnumeratePhysicalDevices") == 0 ||
                     std::strcmp(name, "vkEnumerateInstanceExtensionProperties") == 0;
  return lists ? reinterpret_cast<Function>(count_none) : reinterpret_cast<Function>(nothing);
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) int vk_icdNegotiateLoaderICDInterfaceVersion(
    std::uint32_t* version) {
  *version = 2;  // the loader looks at nothing inside an instance
  return kSuccess;
}

__attribute__((visibility("default"))) Function vk_icdGetInstanceProcAddr(void*, const char* name) {
  return function_of(name);
}
}
