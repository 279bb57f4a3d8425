// Buffer: one VkBuffer with memory of its own, mapped for good where the host can see it.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string_view>

#include "vulkan/device.hpp"

namespace flowdlo::vulkan {

class Buffer {
 public:
  /// `wishes` are memory properties, most wanted first; the first that the device has is taken.
  [[nodiscard]] static Result<Buffer> create(const Device& device, VkDeviceSize bytes,
                                             VkBufferUsageFlags usage,
                                             std::initializer_list<VkMemoryPropertyFlags> wishes,
                                             std::string_view name);

  Buffer() = default;

  [[nodiscard]] VkBuffer handle() const { return buffer_.get(); }
  [[nodiscard]] VkDeviceSize size() const { return size_; }
  /// Null where the host cannot see it.
  [[nodiscard]] std::byte* mapped() const { return mapped_; }

  /// Makes the host's writes visible to the next submission.
  [[nodiscard]] Result<void> flush(const Device& device) const;
  /// Makes a finished submission's writes visible to the host.
  [[nodiscard]] Result<void> invalidate(const Device& device) const;

 private:
  Owned<VkDeviceMemory> memory_;  // freed after the buffer
  Owned<VkBuffer> buffer_;
  VkDeviceSize size_ = 0;
  std::byte* mapped_ = nullptr;
  bool coherent_ = true;  ///< or out of the host's sight: there is nothing to flush
};

}  // namespace flowdlo::vulkan
