// Submission: command buffers, and running one of them with a deadline.
#pragma once

#include <string_view>

#include "vulkan/device.hpp"

namespace flowdlo::vulkan {

class Submission {
 public:
  /// `again`: its command buffers may be begun again.
  [[nodiscard]] static Result<Submission> create(const Device& device, bool again = false);

  Submission() = default;

  /// A new command buffer, begun. It lives as long as the submission.
  [[nodiscard]] Result<VkCommandBuffer> begin(const Device& device, std::string_view name);
  [[nodiscard]] static Result<void> end(const Device& device, VkCommandBuffer commands);

  /// The same buffer from its beginning, once idle.
  [[nodiscard]] static Result<void> begin_again(const Device& device, VkCommandBuffer commands);

  /// Submits and waits. Fails with kDeviceLost after timeout_ms, and then the commands may still
  /// be running: see idle.
  [[nodiscard]] Result<void> run(Device& device, VkCommandBuffer commands, int timeout_ms,
                                 const Meeting& meeting = {});
  /// Whether nothing runs any more, waiting at most wait_ms.
  [[nodiscard]] bool idle(const Device& device, int wait_ms);

 private:
  Owned<VkCommandPool> pool_;
  Owned<VkFence> fence_;
  bool in_flight_ = false;
};

}  // namespace flowdlo::vulkan
