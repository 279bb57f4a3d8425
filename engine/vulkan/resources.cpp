#include "vulkan/resources.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstring>

namespace flowdlo::vulkan {
namespace {

// The strictest alignment of texel and storage buffers that Vulkan lets a device ask for.
constexpr VkDeviceSize kAlignment = 256;

constexpr VkBufferUsageFlags kUsage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
    VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
    VK_BUFFER_USAGE_TRANSFER_DST_BIT;

constexpr VkMemoryPropertyFlags kVisible = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
constexpr VkMemoryPropertyFlags kCoherent = VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkMemoryPropertyFlags kCached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
constexpr VkMemoryPropertyFlags kLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;

std::size_t index_of(Home home) { return static_cast<std::size_t>(home); }

/// Gives the memory back: `content = {}` would only empty it.
void release(std::vector<float>& content) { std::vector<float>().swap(content); }

/// Zeros. A CPU driver's memory is fresh from the system, all zeros and not there until it is
/// written to: a look costs less than the megabytes that no frame may ever use.
void clear(std::byte* memory, VkDeviceSize bytes, bool may_look) {
  constexpr VkDeviceSize kPage = 4096;
  static constexpr std::array<std::byte, kPage> kZeros{};
  for (VkDeviceSize at = 0; at < bytes; at += kPage) {
    const VkDeviceSize size = std::min(kPage, bytes - at);
    if (may_look && std::memcmp(memory + at, kZeros.data(), size) == 0) continue;
    std::memset(memory + at, 0, size);
  }
}

}  // namespace

std::uint32_t Resources::add(Home home, VkDeviceSize bytes, std::string_view name,
                             std::vector<float> content) {
  assert(content.empty() || content.size() * sizeof(float) == bytes);
  items_.push_back({home, bytes, 0, std::string(name), std::move(content)});
  return static_cast<std::uint32_t>(items_.size() - 1);
}

std::array<VkDeviceSize, 3> Resources::lay_out() {
  std::array<VkDeviceSize, 3> sizes{};
  for (Item& item : items_) {
    VkDeviceSize& size = sizes[index_of(item.home)];
    item.offset = size;
    size += (item.bytes + kAlignment - 1) / kAlignment * kAlignment;
  }
  for (VkDeviceSize& size : sizes) {
    // Never a power of two: lavapipe compiles a shader once more for buffers of such sizes.
    if (size == 0 || std::has_single_bit(size)) size += 3 * kAlignment;
  }
  return sizes;
}

Result<void> Resources::allocate(const Device& device) {
  const auto sizes = lay_out();
  auto inputs =
      Buffer::create(device, sizes[0], kUsage,
                     {kVisible | kCoherent | kLocal, kVisible | kCoherent, kVisible}, "inputs");
  if (!inputs) return inputs.error();
  auto outputs =
      Buffer::create(device, sizes[1], kUsage,
                     {kVisible | kCached | kCoherent, kVisible | kCached, kVisible}, "outputs");
  if (!outputs) return outputs.error();
  const bool shares_memory = device.facts().report.kind == DeviceKind::kCpu;
  auto own = shares_memory ? Buffer::create(device, sizes[2], kUsage,
                                            {kVisible | kCoherent, kVisible}, "tensors")
                           : Buffer::create(device, sizes[2], kUsage, {kLocal, 0}, "tensors");
  if (!own) return own.error();
  buffers_ = {*std::move(inputs), *std::move(outputs), *std::move(own)};
  clear(buffers_[0].mapped(), buffers_[0].size(), shares_memory);
  clear(buffers_[1].mapped(), buffers_[1].size(), shares_memory);
  if (buffers_[2].mapped() != nullptr) fill_own();
  for (const Buffer& buffer : buffers_) {
    const auto flushed = buffer.flush(device);
    if (!flushed) return flushed.error();
  }
  return {};
}

void Resources::fill_own() {
  std::byte* const memory = buffers_[index_of(Home::kDevice)].mapped();
  VkDeviceSize filled = 0;
  const auto zeros_to = [&](VkDeviceSize end) { clear(memory + filled, end - filled, true); };
  for (Item& item : items_) {
    if (item.content.empty()) continue;
    zeros_to(item.offset);
    std::memcpy(memory + item.offset, item.content.data(), item.bytes);
    filled = item.offset + item.bytes;
    release(item.content);
  }
  zeros_to(buffers_[index_of(Home::kDevice)].size());
}

Result<Buffer> Resources::record_upload(const Device& device, VkCommandBuffer commands) {
  if (buffers_[index_of(Home::kDevice)].mapped() != nullptr) return Buffer{};
  VkDeviceSize bytes = 4;
  for (const Item& item : items_) bytes += item.content.size() * sizeof(float);
  auto staging = Buffer::create(device, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                {kVisible | kCoherent, kVisible}, "staging");
  if (!staging) return staging.error();

  std::vector<VkBufferCopy> copies;
  VkDeviceSize offset = 0;
  for (Item& item : items_) {
    if (item.content.empty()) continue;
    std::memcpy(staging->mapped() + offset, item.content.data(), item.bytes);
    copies.push_back({.srcOffset = offset, .dstOffset = item.offset, .size = item.bytes});
    offset += item.bytes;
    release(item.content);
  }
  const auto flushed = staging->flush(device);
  if (!flushed) return flushed.error();

  const VolkDeviceTable& api = device.api();
  const VkBuffer own = buffers_[index_of(Home::kDevice)].handle();
  const auto barrier = [&](VkPipelineStageFlags next, VkAccessFlags access) {
    const VkMemoryBarrier memory{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                 .pNext = nullptr,
                                 .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                 .dstAccessMask = access};
    api.vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, next, 0, 1, &memory, 0,
                             nullptr, 0, nullptr);
  };
  api.vkCmdFillBuffer(commands, own, 0, VK_WHOLE_SIZE, 0);
  barrier(VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
  if (!copies.empty()) {
    api.vkCmdCopyBuffer(commands, staging->handle(), own, static_cast<std::uint32_t>(copies.size()),
                        copies.data());
  }
  barrier(VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT |
              VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
          VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_READ_BIT |
              VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
  return staging;
}

Resources::Place Resources::place(const Range& range) const {
  const Item& item = items_[range.resource];
  return {buffers_[index_of(item.home)].handle(), item.offset + range.offset};
}

std::span<float> Resources::host(std::uint32_t id) const {
  const Item& item = items_[id];
  assert(item.home != Home::kDevice);
  std::byte* const first = buffers_[index_of(item.home)].mapped() + item.offset;
  return {reinterpret_cast<float*>(first), item.bytes / sizeof(float)};
}

}  // namespace flowdlo::vulkan
