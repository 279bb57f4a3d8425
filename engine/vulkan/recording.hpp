// Recording: a plan's steps as Vulkan commands, with barriers where one depends on another.
#pragma once

#include <string>
#include <vector>

#include "vulkan/descriptors.hpp"
#include "vulkan/plan.hpp"
#include "vulkan/timestamps.hpp"

namespace flowdlo::vulkan {

/// What a plan has become on a device.
struct Compiled {
  std::vector<const Kernel*> kernels;
  Descriptors descriptors;
};

/// The whole plan, once; results are visible to the host afterwards. Timestamp 0 stands at the
/// start, i + 1 at the end of the i-th stage.
void record_run(const Device& device, const Plan& plan, const Compiled& compiled,
                const Timestamps& timestamps, VkCommandBuffer commands);

/// One dispatch of each kernel and each shape of its bindings: drivers that compile at the first
/// dispatch do it then.
void record_warm_up(const Device& device, const Plan& plan, const Compiled& compiled,
                    VkCommandBuffer commands);

/// The stages' names in order; what comes before the first StageMark is "start".
[[nodiscard]] std::vector<std::string> stage_names(const Plan& plan);

}  // namespace flowdlo::vulkan
