// check: every VkResult of this room passes through here.
#pragma once

#include <string>
#include <string_view>

#include "flowdlo/result.hpp"
#include "vulkan/vulkan_api.hpp"

namespace flowdlo::vulkan {

/// VK_SUCCESS, or an error `operation: VK_ERROR_... on "device"`. `operation` is the call with what
/// it is about, "vkCreateBuffer(scratch)". A host without memory is kOutOfMemory, what a
/// device cannot do at all kNoDevice, every other failure of a device kDeviceLost.
[[nodiscard]] Result<void> check(VkResult result, std::string_view operation,
                                 std::string_view device);

/// "VK_ERROR_DEVICE_LOST", or the number of a code that has no name here.
[[nodiscard]] std::string name_of(VkResult result);

}  // namespace flowdlo::vulkan
