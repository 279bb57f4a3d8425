// A Vulkan driver that does what no driver should, by the definition FALSE_DRIVER_FAULT:
//   1 ends its process by abort() when it is asked for its devices,
//   2 sleeps for ever when it is asked for an instance,
//   3 leaves its process by exit() when it is asked for its devices.
// Each time it is loaded it writes a byte to the file that FALSE_DRIVER_LOG names.
#include <fcntl.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace {

using Function = void (*)();
constexpr int kSuccess = 0;  // VK_SUCCESS
void* instance[1] = {};      // what a VkInstance points at

int create_instance(const void*, const void*, void** created) {
#if FALSE_DRIVER_FAULT == 2
  for (;;) ::sleep(1);
#endif
  *created = static_cast<void*>(instance);
  return kSuccess;
}

int list_devices(void*, std::uint32_t* count, void*) {
#if FALSE_DRIVER_FAULT == 1
  std::abort();
#elif FALSE_DRIVER_FAULT == 3
  std::exit(0);
#endif
  *count = 0;
  return kSuccess;
}

int count_none(const char*, std::uint32_t* count, void*) {
  *count = 0;
  return kSuccess;
}

int nothing() { return kSuccess; }

Function function_of(const char* name) {
  if (std::strcmp(name, "vkCreateInstance") == 0) {
    return reinterpret_cast<Function>(create_instance);
  }
  if (std::strcmp(name, "vkEnumeratePhysicalDevices") == 0) {
    return reinterpret_cast<Function>(list_devices);
  }
  if (std::strcmp(name, "vkEnumerateInstanceExtensionProperties") == 0) {
    return reinterpret_cast<Function>(count_none);
  }
  return reinterpret_cast<Function>(nothing);
}

__attribute__((constructor)) void note_that_it_was_loaded() {
  const char* const log = std::getenv("FALSE_DRIVER_LOG");
  if (log == nullptr) return;
  const int file = ::open(log, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (file < 0) return;
  if (::write(file, "1", 1) != 1) std::abort();
  ::close(file);
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
