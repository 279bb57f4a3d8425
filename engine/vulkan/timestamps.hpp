// Timestamps: the device's clock at points of a command buffer.
#pragma once

#include <cstdint>
#include <vector>

#include "vulkan/device.hpp"

namespace flowdlo::vulkan {

class Timestamps {
 public:
  /// Room for `count` of them; none at all where the queue has no clock.
  [[nodiscard]] static Result<Timestamps> create(const Device& device, std::uint32_t count);

  Timestamps() = default;

  [[nodiscard]] bool available() const { return pool_.get() != VK_NULL_HANDLE; }
  void reset(const Device& device, VkCommandBuffer commands) const;
  /// Taken once everything recorded before it is done.
  void write(const Device& device, VkCommandBuffer commands, std::uint32_t index) const;
  /// Milliseconds from each to the next, [count - 1]; empty where the device gives none.
  [[nodiscard]] std::vector<double> intervals_ms(const Device& device) const;

 private:
  Owned<VkQueryPool> pool_;
  std::uint32_t count_ = 0;
};

}  // namespace flowdlo::vulkan
