// Instance: one VkInstance with its function table, and what the validation layers said.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "flowdlo/result.hpp"
#include "vulkan/loader.hpp"
#include "vulkan/vulkan_api.hpp"

namespace flowdlo::vulkan {

/// Messages of the validation layers; they come from any thread.
class MessageLog {
 public:
  void add(std::string message) {
    const std::lock_guard lock(mutex_);
    messages_.push_back(std::move(message));
  }
  [[nodiscard]] std::vector<std::string> messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> messages_;
};

class Instance {
 public:
  /// With `validation`, the Khronos layer checks core and synchronization rules where it is
  /// installed. Fails with kNoDevice.
  [[nodiscard]] static Result<std::unique_ptr<Instance>> create(
      std::shared_ptr<const Loader> loader, bool validation);

  /// A host's, which is never destroyed here. `debug`: it was made with VK_EXT_debug_utils. Fails
  /// with kBadInput where a function is missing.
  [[nodiscard]] static Result<std::unique_ptr<Instance>> borrow(PFN_vkGetInstanceProcAddr get,
                                                                VkInstance handle, bool debug);

  [[nodiscard]] const InstanceTable& api() const { return api_; }
  [[nodiscard]] VkInstance handle() const { return handle_; }
  [[nodiscard]] const Loader& loader() const { return *loader_; }
  [[nodiscard]] const MessageLog& log() const { return *log_; }
  [[nodiscard]] bool validates() const { return messenger_ != VK_NULL_HANDLE; }
  /// Whether nothing looks on that would not know what Vulkan `version` brought: a validation layer
  /// takes structures that are younger than itself for faults.
  [[nodiscard]] bool may_use(std::uint32_t version) const { return version <= layer_version_; }

  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;
  ~Instance();

 private:
  explicit Instance(std::shared_ptr<const Loader> loader) : loader_(std::move(loader)) {}

  [[nodiscard]] Result<void> load_functions(bool debug);
  [[nodiscard]] Result<void> listen();

  std::shared_ptr<const Loader> loader_;
  VkInstance handle_ = VK_NULL_HANDLE;
  bool owned_ = true;
  std::uint32_t layer_version_ = UINT32_MAX;  // where one is loaded
  InstanceTable api_;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  std::unique_ptr<MessageLog> log_ = std::make_unique<MessageLog>();
};

}  // namespace flowdlo::vulkan
