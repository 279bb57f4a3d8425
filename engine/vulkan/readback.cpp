#include "vulkan/readback.hpp"

#include <fmt/format.h>

#include <cstring>
#include <string>
#include <utility>

#include "vulkan/vulkan_api.hpp"
// Behind it, for that says that Vulkan's functions have no prototypes.
#include "flowdlo/vulkan.hpp"
#include "vulkan/buffer.hpp"
#include "vulkan/device.hpp"
#include "vulkan/submission.hpp"

namespace flowdlo::vulkan {
namespace {

constexpr int kLargestSide = 4096;  // pixels
constexpr int kFarewell_ms = 5000;  // a destructor's patience with a copy that never ends
constexpr VkMemoryPropertyFlags kVisible = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
constexpr VkMemoryPropertyFlags kCoherent = VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkMemoryPropertyFlags kCached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;

std::size_t pixels_of(const VulkanFrame& frame) {
  return static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
}

/// Depth first, then the mask.
VkDeviceSize depth_bytes(const VulkanFrame& frame) { return sizeof(float) * pixels_of(frame); }

void add(std::string& faults, const std::string& fault) {
  faults += fmt::format("{}VulkanFrame.{}", faults.empty() ? "" : "\n", fault);
}

/// What is wrong with the semaphores: then nothing can be submitted at all.
std::string faults_of_moments(const VulkanFrame& frame, const Device& device) {
  std::string faults;
  const auto check = [&](std::span<const VulkanMoment> moments, const char* name) {
    for (std::size_t i = 0; i < moments.size(); ++i) {
      if (moments[i].semaphore != VK_NULL_HANDLE) continue;
      add(faults, fmt::format("{}[{}].semaphore: expected a VkSemaphore, got null", name, i));
    }
  };
  check(frame.waits, "waits");
  check(frame.signals, "signals");
  if (!device.has_timelines() && !(frame.waits.empty() && frame.signals.empty())) {
    add(faults,
        "waits, signals: expected none on a device without timeline semaphores, got some; enable "
        "timelineSemaphore and say so in VulkanHost.enabled.timeline_semaphore");
  }
  return faults;
}

void check_image(const VulkanImage& image, VkDeviceSize bytes, const char* name,
                 const Device& device, std::string& faults) {
  if (image.buffer == VK_NULL_HANDLE) {
    add(faults, fmt::format("{}.buffer: expected a VkBuffer, got null", name));
    return;
  }
  VkMemoryRequirements needs{};  // at least as large as the buffer
  device.api().vkGetBufferMemoryRequirements(device.handle(), image.buffer, &needs);
  if (image.offset <= needs.size && bytes <= needs.size - image.offset) return;
  add(faults, fmt::format("{}: expected a buffer of {} bytes from {} on, got one of at most {}",
                          name, bytes, image.offset, needs.size));
}

std::string faults_of_images(const VulkanFrame& frame, const Device& device) {
  std::string faults;
  const auto is_side = [](int side) { return side >= 1 && side <= kLargestSide; };
  if (!is_side(frame.width) || !is_side(frame.height)) {
    add(faults, fmt::format("width, height: expected 1..{}, got {} x {}", kLargestSide, frame.width,
                            frame.height));
    return faults;
  }
  check_image(frame.depth_m, depth_bytes(frame), "depth_m", device, faults);
  check_image(frame.mask, pixels_of(frame), "mask", device, faults);
  return faults;
}

Moments moments_of(std::span<const VulkanMoment> given) {
  Moments moments;
  for (const VulkanMoment& moment : given) {
    moments.semaphores.push_back(moment.semaphore);
    moments.values.push_back(moment.value);
  }
  return moments;
}

void record_barrier(const Device& device, VkCommandBuffer commands, VkPipelineStageFlags from,
                    VkAccessFlags written, VkPipelineStageFlags to, VkAccessFlags read) {
  const VkMemoryBarrier memory{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                               .pNext = nullptr,
                               .srcAccessMask = written,
                               .dstAccessMask = read};
  device.api().vkCmdPipelineBarrier(commands, from, to, 0, 1, &memory, 0, nullptr, 0, nullptr);
}

}  // namespace

/// Everything that a copy under way may touch.
struct Readback::Work {
  std::shared_ptr<Device> device;  // outlives all below
  Buffer staging{};
  Submission submission{};
  VkCommandBuffer commands = VK_NULL_HANDLE;

  [[nodiscard]] Result<void> prepare(VkDeviceSize bytes);
  [[nodiscard]] Result<void> record(const VulkanFrame& frame) const;
};

Result<void> Readback::Work::prepare(VkDeviceSize bytes) {
  if (staging.size() < bytes) {
    staging = {};
    auto larger =
        Buffer::create(*device, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                       {kVisible | kCached | kCoherent, kVisible | kCached, kVisible}, "frame");
    if (!larger) return larger.error();
    staging = *std::move(larger);
  }
  if (commands == VK_NULL_HANDLE) {
    auto made = Submission::create(*device, /*again=*/true);
    if (!made) return made.error();
    submission = *std::move(made);
    const auto begun = submission.begin(*device, "frame");
    if (!begun) return begun.error();
    commands = *begun;
    return {};
  }
  return Submission::begin_again(*device, commands);
}

Result<void> Readback::Work::record(const VulkanFrame& frame) const {
  const auto copy = [&](const VulkanImage& from, VkDeviceSize to, VkDeviceSize bytes) {
    const VkBufferCopy region{.srcOffset = from.offset, .dstOffset = to, .size = bytes};
    device->api().vkCmdCopyBuffer(commands, from.buffer, staging.handle(), 1, &region);
  };
  // Whatever this queue was given before may have written them.
  record_barrier(*device, commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT,
                 VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
  copy(frame.depth_m, 0, depth_bytes(frame));
  copy(frame.mask, depth_bytes(frame), pixels_of(frame));
  record_barrier(*device, commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                 VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
  return Submission::end(*device, commands);
}

Readback::Readback(std::shared_ptr<Device> device, int timeout_ms)
    : work_(new Work{std::move(device)}), timeout_ms_(timeout_ms) {}

Readback::~Readback() {
  if (!work_->submission.idle(*work_->device, kFarewell_ms)) {
    (void)work_.release();  // NOLINT: given up on purpose, see the declaration
  }
}

Result<Frame> Readback::read(const VulkanFrame& frame) {
  Device& device = *work_->device;
  if (const std::string faults = faults_of_moments(frame, device); !faults.empty()) {
    return Error{ErrorCode::kBadInput, faults};
  }
  const Meeting meeting{.waits = moments_of(frame.waits), .signals = moments_of(frame.signals)};
  const auto failed = [&](Error error) {  // the host is not left waiting
    if (!meeting.signals.semaphores.empty()) {
      (void)device.submit(VK_NULL_HANDLE, VK_NULL_HANDLE, meeting);
    }
    return error;
  };
  if (const std::string faults = faults_of_images(frame, device); !faults.empty()) {
    return failed({ErrorCode::kBadInput, faults});
  }
  if (!work_->submission.idle(device, 0)) {
    return failed(
        {ErrorCode::kDeviceLost,
         fmt::format("VulkanFrame: expected the frame before to be copied, got one that "
                     "\"{}\" is still at; signal what it waits for, or make the device anew",
                     device.facts().report.name)});
  }
  depth_m_.resize(pixels_of(frame));
  mask_.resize(pixels_of(frame));
  auto ready = work_->prepare(depth_bytes(frame) + pixels_of(frame));
  if (ready) ready = work_->record(frame);
  if (!ready) return failed(ready.error());
  const auto copied = work_->submission.run(device, work_->commands, timeout_ms_, meeting);
  if (!copied) return copied.error();
  const auto seen = work_->staging.invalidate(device);
  if (!seen) return seen.error();
  std::memcpy(depth_m_.data(), work_->staging.mapped(), depth_bytes(frame));
  std::memcpy(mask_.data(), work_->staging.mapped() + depth_bytes(frame), mask_.size());
  return Frame{.width = frame.width,
               .height = frame.height,
               .intrinsics = frame.intrinsics,
               .depth_m = depth_m_,
               .mask = mask_,
               .color_bgr = frame.color_bgr,
               .instances = frame.instances};
}

}  // namespace flowdlo::vulkan
