#include "vulkan/buffer.hpp"

#include <fmt/format.h>

#include <optional>

namespace flowdlo::vulkan {
namespace {

std::optional<std::uint32_t> find_type(const VkPhysicalDeviceMemoryProperties& memory,
                                       std::uint32_t allowed,
                                       std::initializer_list<VkMemoryPropertyFlags> wishes) {
  for (const VkMemoryPropertyFlags wish : wishes) {
    for (std::uint32_t type = 0; type < memory.memoryTypeCount; ++type) {
      const bool fits = (memory.memoryTypes[type].propertyFlags & wish) == wish;
      if (fits && (allowed & (1U << type)) != 0) return type;
    }
  }
  return std::nullopt;
}

}  // namespace

Result<void> Buffer::flush(const Device& device) const {
  if (coherent_) return {};
  const VkMappedMemoryRange range{.sType = VK_STRUCTURE_TYPE_MAPPED_MEMORY_RANGE,
                                  .pNext = nullptr,
                                  .memory = memory_.get(),
                                  .offset = 0,
                                  .size = VK_WHOLE_SIZE};
  return device.check(device.api().vkFlushMappedMemoryRanges(device.handle(), 1, &range),
                      "vkFlushMappedMemoryRanges");
}

Result<void> Buffer::invalidate(const Device& device) const {
  if (coherent_) return {};
  const VkMappedMemoryRange range{.sType = VK_STRUCTURE_TYPE_MAPPED_MEMORY_RANGE,
                                  .pNext = nullptr,
                                  .memory = memory_.get(),
                                  .offset = 0,
                                  .size = VK_WHOLE_SIZE};
  return device.check(device.api().vkInvalidateMappedMemoryRanges(device.handle(), 1, &range),
                      "vkInvalidateMappedMemoryRanges");
}

Result<Buffer> Buffer::create(const Device& device, VkDeviceSize bytes, VkBufferUsageFlags usage,
                              std::initializer_list<VkMemoryPropertyFlags> wishes,
                              std::string_view name) {
  const VolkDeviceTable& api = device.api();
  const VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                .pNext = nullptr,
                                .flags = 0,
                                .size = bytes,
                                .usage = usage,
                                .sharingMode = VK_SHARING_MODE_EXCLUSIVE,
                                .queueFamilyIndexCount = 0,
                                .pQueueFamilyIndices = nullptr};
  Buffer result;
  auto buffer =
      device.create(api.vkCreateBuffer, api.vkDestroyBuffer, info, VK_OBJECT_TYPE_BUFFER, name);
  if (!buffer) return buffer.error();

  VkMemoryRequirements needs{};
  api.vkGetBufferMemoryRequirements(device.handle(), buffer->get(), &needs);
  const auto type = find_type(device.facts().memory, needs.memoryTypeBits, wishes);
  if (!type) {
    return Error{ErrorCode::kNoDevice,
                 fmt::format("\"{}\": expected a memory type for {}, found none",
                             device.facts().report.name, name)};
  }
  const VkMemoryAllocateInfo allocation{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                        .pNext = nullptr,
                                        .allocationSize = needs.size,
                                        .memoryTypeIndex = *type};
  VkDeviceMemory memory = VK_NULL_HANDLE;
  const VkResult made =
      api.vkAllocateMemory(device.handle(), &allocation, device.allocation(), &memory);
  result.memory_ =
      Owned<VkDeviceMemory>(device.handle(), memory, api.vkFreeMemory, device.allocation());
  const auto allocated =
      device.check(made, fmt::format("vkAllocateMemory({}, {} bytes)", name, needs.size));
  if (!allocated) return allocated.error();
  device.name(VK_OBJECT_TYPE_DEVICE_MEMORY, memory, name);
  result.buffer_ = *std::move(buffer);
  result.size_ = bytes;
  const auto bound =
      device.check(api.vkBindBufferMemory(device.handle(), result.buffer_.get(), memory, 0),
                   fmt::format("vkBindBufferMemory({})", name));
  if (!bound) return bound.error();

  const bool for_host = (*wishes.begin() & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0;
  if (!for_host) return result;
  void* address = nullptr;
  const auto mapped =
      device.check(api.vkMapMemory(device.handle(), memory, 0, VK_WHOLE_SIZE, 0, &address),
                   fmt::format("vkMapMemory({})", name));
  if (!mapped) return mapped.error();
  result.mapped_ = static_cast<std::byte*>(address);
  const VkMemoryPropertyFlags has = device.facts().memory.memoryTypes[*type].propertyFlags;
  result.coherent_ = (has & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT) != 0;
  return result;
}

}  // namespace flowdlo::vulkan
