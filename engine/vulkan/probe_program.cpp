// flowdlo-probe: asks one Vulkan driver everything that the library asks it before it is used, in a
// process of its own. The environment names the driver's manifest. What is about to be done is said
// on descriptor 3, a line each, so that the last one tells where a driver ended or stayed.
//
//   flowdlo-probe PARENT SECONDS   PARENT: the process that started it, without which it ends
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <string>

#include "vulkan/instance.hpp"
#include "vulkan/physical_device.hpp"

namespace flowdlo::vulkan {
namespace {

constexpr int kVoice = 3;

void say(const std::string& line) {
  const std::string whole = line + "\n";
  if (::write(kVoice, whole.data(), whole.size()) < 0) std::_Exit(EXIT_FAILURE);
}

/// This process leaves nothing behind: no orphan, no core file, no process that goes on for ever.
void be_mortal(int parent, int seconds) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) std::_Exit(EXIT_FAILURE);
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
  ::alarm(static_cast<unsigned>(seconds));
}

/// One device with its compute queue, opened and closed again.
void open(const Instance& instance, const PhysicalDevice& physical) {
  const float priority = 1.0F;
  VkDeviceQueueCreateInfo queue{};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueFamilyIndex = physical.queue_family;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkDeviceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = physical.portability ? 1 : 0;
  info.ppEnabledExtensionNames = &kPortabilitySubset;
  VkDevice device = VK_NULL_HANDLE;
  const InstanceTable& api = instance.api();
  if (api.vkCreateDevice(physical.handle, &info, nullptr, &device) != VK_SUCCESS) return;
  const auto destroy =
      reinterpret_cast<PFN_vkDestroyDevice>(api.vkGetDeviceProcAddr(device, "vkDestroyDevice"));
  if (destroy != nullptr) destroy(device, nullptr);
}

/// How many devices the driver has. One that fails politely has none.
std::size_t ask_everything() {
  const auto loader = Loader::open();
  if (!loader) return 0;
  say("made its instance");
  const auto instance = Instance::create(*loader, /*validation=*/false);
  if (!instance) return 0;
  say("listed its devices");
  const auto devices = physical_devices(**instance);
  for (const PhysicalDevice& device : devices) {
    if (!device.report.lacks.empty()) continue;  // is never opened
    say("opened a device");
    open(**instance, device);
  }
  say("closed its instance");
  return devices.size();
}

}  // namespace
}  // namespace flowdlo::vulkan

int main(int count, char** arguments) {
  using namespace flowdlo::vulkan;
  if (count != 3) return EXIT_FAILURE;
  be_mortal(std::atoi(arguments[1]), std::atoi(arguments[2]));
  const auto devices = ask_everything();
  say("devices " + std::to_string(devices));
  say("done");
  std::_Exit(EXIT_SUCCESS);  // the host ends without the driver's last words, or much later
}
