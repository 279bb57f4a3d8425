// Host: a program with a Vulkan device of its own, under the validation layers. It links the loader
// as programs do, and knows nothing of the engine.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "flowdlo/vulkan.hpp"

namespace flowdlo::testing {

/// What the validation layers say, from any thread.
struct Heard {
  std::mutex mutex;
  std::vector<std::string> messages;
};

struct Wishes {
  std::uint32_t api_version = VK_API_VERSION_1_2;
  bool features = true;  ///< all that FlowDLO wants; without, only what it requires
  bool layers = true;
};

class Host {
 public:
  /// Null where this machine has no Vulkan device, or where something failed, which is then
  /// printed.
  [[nodiscard]] static std::unique_ptr<Host> make(const Wishes& wishes = Wishes());

  /// With a mutex of this host around submissions.
  [[nodiscard]] VulkanHost handed_over();
  [[nodiscard]] const VulkanNeeds& needs() const { return needs_; }

  [[nodiscard]] VkDevice device() const { return device_; }
  [[nodiscard]] std::uint32_t queue_family() const { return family_; }
  /// In the lock.
  [[nodiscard]] VkResult submit(const VkSubmitInfo& info);
  /// The same, and waits until it is done.
  [[nodiscard]] VkResult submit_and_wait(const VkSubmitInfo& info);
  [[nodiscard]] VkCommandBuffer begin();
  [[nodiscard]] std::uint32_t memory_type(std::uint32_t allowed,
                                          VkMemoryPropertyFlags wanted) const;
  [[nodiscard]] long times_locked() const { return times_locked_; }

  /// Empty where the layers are installed and had nothing to say; it outlives this host.
  [[nodiscard]] std::shared_ptr<Heard> heard() const { return heard_; }
  [[nodiscard]] bool is_watched() const { return messenger_ != VK_NULL_HANDLE; }

  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;
  ~Host();

 private:
  Host() = default;
  [[nodiscard]] bool make_instance(const Wishes& wishes);
  [[nodiscard]] bool make_device(const Wishes& wishes);

  std::shared_ptr<Heard> heard_ = std::make_shared<Heard>();
  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  std::uint32_t api_version_ = 0;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VulkanNeeds needs_;
  VulkanFeatures enabled_;
  VkDevice device_ = VK_NULL_HANDLE;
  std::uint32_t family_ = 0;
  VkQueue queue_ = VK_NULL_HANDLE;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  std::mutex mutex_;
  long times_locked_ = 0;
};

/// A timeline semaphore of the host's.
class Timeline {
 public:
  explicit Timeline(const Host& host);
  ~Timeline();
  Timeline(const Timeline&) = delete;
  Timeline& operator=(const Timeline&) = delete;

  [[nodiscard]] VulkanMoment at(std::uint64_t value) const { return {semaphore_, value}; }
  void signal(std::uint64_t value) const;
  [[nodiscard]] std::uint64_t value() const;
  /// Whether that came within 10 s.
  [[nodiscard]] bool comes_to(std::uint64_t value) const;

 private:
  VkDevice device_;
  VkSemaphore semaphore_ = VK_NULL_HANDLE;
};

/// A buffer of the host's in memory that it has mapped.
class HostBuffer {
 public:
  HostBuffer(const Host& host, VkDeviceSize bytes);
  ~HostBuffer();
  HostBuffer(const HostBuffer&) = delete;
  HostBuffer& operator=(const HostBuffer&) = delete;

  [[nodiscard]] VkBuffer handle() const { return buffer_; }
  [[nodiscard]] std::uint8_t* bytes() const { return bytes_; }

 private:
  VkDevice device_;
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  std::uint8_t* bytes_ = nullptr;
};

}  // namespace flowdlo::testing
