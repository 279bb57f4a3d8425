// Owned: a device-level Vulkan handle that destroys itself. Move-only.
#pragma once

#include <utility>

#include "vulkan/vulkan_api.hpp"

namespace flowdlo::vulkan {

template <class Handle>
class Owned {
 public:
  using Destroy = void(VKAPI_PTR*)(VkDevice, Handle, const VkAllocationCallbacks*);

  Owned() = default;
  /// `allocation`: what it was made with; outlives it.
  Owned(VkDevice device, Handle handle, Destroy destroy, const VkAllocationCallbacks* allocation)
      : device_(device), handle_(handle), destroy_(destroy), allocation_(allocation) {}
  Owned(Owned&& other) noexcept
      : device_(other.device_),
        handle_(std::exchange(other.handle_, VK_NULL_HANDLE)),
        destroy_(other.destroy_),
        allocation_(other.allocation_) {}
  Owned& operator=(Owned&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(handle_, other.handle_);
    std::swap(destroy_, other.destroy_);
    std::swap(allocation_, other.allocation_);
    return *this;
  }
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  ~Owned() {
    if (handle_ != VK_NULL_HANDLE) destroy_(device_, handle_, allocation_);
  }

  [[nodiscard]] Handle get() const { return handle_; }

 private:
  VkDevice device_ = VK_NULL_HANDLE;
  Handle handle_ = VK_NULL_HANDLE;
  Destroy destroy_ = nullptr;
  const VkAllocationCallbacks* allocation_ = nullptr;
};

}  // namespace flowdlo::vulkan
