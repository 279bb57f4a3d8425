#include "vulkan/timestamps.hpp"

namespace flowdlo::vulkan {

Result<Timestamps> Timestamps::create(const Device& device, std::uint32_t count) {
  Timestamps timestamps;
  if (device.facts().timestamp_bits == 0 || count == 0) return timestamps;
  const VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                   .pNext = nullptr,
                                   .flags = 0,
                                   .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                   .queryCount = count,
                                   .pipelineStatistics = 0};
  auto pool = device.create(device.api().vkCreateQueryPool, device.api().vkDestroyQueryPool, info,
                            VK_OBJECT_TYPE_QUERY_POOL, "stages");
  if (!pool) return pool.error();
  timestamps.pool_ = *std::move(pool);
  timestamps.count_ = count;
  return timestamps;
}

void Timestamps::reset(const Device& device, VkCommandBuffer commands) const {
  if (available()) device.api().vkCmdResetQueryPool(commands, pool_.get(), 0, count_);
}

void Timestamps::write(const Device& device, VkCommandBuffer commands, std::uint32_t index) const {
  if (!available()) return;
  device.api().vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, pool_.get(),
                                   index);
}

std::vector<double> Timestamps::intervals_ms(const Device& device) const {
  if (!available()) return {};
  std::vector<std::uint64_t> ticks(count_);
  const VkResult read = device.api().vkGetQueryPoolResults(
      device.handle(), pool_.get(), 0, count_, ticks.size() * sizeof(ticks[0]), ticks.data(),
      sizeof(ticks[0]), VK_QUERY_RESULT_64_BIT);
  if (read != VK_SUCCESS) return {};

  const std::uint32_t bits = device.facts().timestamp_bits;
  const std::uint64_t mask = bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  const double tick_ms = static_cast<double>(device.facts().limits.timestampPeriod) * 1e-6;
  std::vector<double> intervals;
  for (std::uint32_t i = 1; i < count_; ++i) {
    intervals.push_back(static_cast<double>((ticks[i] - ticks[i - 1]) & mask) * tick_ms);
  }
  return intervals;
}

}  // namespace flowdlo::vulkan
