#include "vulkan/check.hpp"

#include <fmt/format.h>

namespace flowdlo::vulkan {
namespace {

ErrorCode code_of(VkResult result) {
  switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      return ErrorCode::kOutOfMemory;
    case VK_ERROR_INCOMPATIBLE_DRIVER:
    case VK_ERROR_EXTENSION_NOT_PRESENT:
    case VK_ERROR_FEATURE_NOT_PRESENT:
    case VK_ERROR_LAYER_NOT_PRESENT:
    case VK_ERROR_INITIALIZATION_FAILED:
      return ErrorCode::kNoDevice;
    default:  // lost, out of memory or of some other thing that it has: the device's failure
      return ErrorCode::kDeviceLost;
  }
}

}  // namespace

std::string name_of(VkResult result) {
#define FLOWDLO_CASE(name) \
  case name:               \
    return #name;
  switch (result) {
    FLOWDLO_CASE(VK_SUCCESS)
    FLOWDLO_CASE(VK_NOT_READY)
    FLOWDLO_CASE(VK_TIMEOUT)
    FLOWDLO_CASE(VK_INCOMPLETE)
    FLOWDLO_CASE(VK_ERROR_OUT_OF_HOST_MEMORY)
    FLOWDLO_CASE(VK_ERROR_OUT_OF_DEVICE_MEMORY)
    FLOWDLO_CASE(VK_ERROR_INITIALIZATION_FAILED)
    FLOWDLO_CASE(VK_ERROR_DEVICE_LOST)
    FLOWDLO_CASE(VK_ERROR_MEMORY_MAP_FAILED)
    FLOWDLO_CASE(VK_ERROR_LAYER_NOT_PRESENT)
    FLOWDLO_CASE(VK_ERROR_EXTENSION_NOT_PRESENT)
    FLOWDLO_CASE(VK_ERROR_FEATURE_NOT_PRESENT)
    FLOWDLO_CASE(VK_ERROR_INCOMPATIBLE_DRIVER)
    FLOWDLO_CASE(VK_ERROR_TOO_MANY_OBJECTS)
    FLOWDLO_CASE(VK_ERROR_FORMAT_NOT_SUPPORTED)
    FLOWDLO_CASE(VK_ERROR_FRAGMENTED_POOL)
    FLOWDLO_CASE(VK_ERROR_OUT_OF_POOL_MEMORY)
    FLOWDLO_CASE(VK_ERROR_FRAGMENTATION)
    FLOWDLO_CASE(VK_ERROR_UNKNOWN)
    default:
      return fmt::format("VkResult {}", static_cast<int>(result));
  }
#undef FLOWDLO_CASE
}

Result<void> check(VkResult result, std::string_view operation, std::string_view device) {
  if (result == VK_SUCCESS) return {};
  return Error{code_of(result),
               fmt::format("{}: {} on \"{}\"", operation, name_of(result), device)};
}

}  // namespace flowdlo::vulkan
