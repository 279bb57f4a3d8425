#include "vulkan/absence.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <string>

namespace flowdlo::vulkan {
namespace {

// Packages as Debian and Ubuntu name them.
constexpr const char* kDrivers =
    "mesa-vulkan-drivers for AMD, Intel and, where there is no GPU, the CPU driver lavapipe, or "
    "NVIDIA's own driver for NVIDIA";
constexpr const char* kWithout = "or take the device \"cpu\"";

/// Variables that tell the loader where to look, where they are set: then that may be the reason.
std::string overrides() {
  std::string text;
  for (const char* variable : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) {
    const char* const value = std::getenv(variable);
    if (value != nullptr) text += fmt::format("check {}, which is \"{}\", ", variable, value);
  }
  return text;
}

}  // namespace

Error no_loader(std::string_view reason) {
  return {ErrorCode::kNoDevice,
          fmt::format("Vulkan: expected the loader libvulkan.so.1, got \"{}\"; install libvulkan1 "
                      "and a driver ({}), {}",
                      reason, kDrivers, kWithout)};
}

Error no_driver() {
  return {ErrorCode::kNoDevice,
          fmt::format("Vulkan: expected a driver, got none from the loader; {}install one ({}), {}",
                      overrides(), kDrivers, kWithout)};
}

Error no_device() {
  return {ErrorCode::kNoDevice,
          fmt::format("Vulkan: expected a device, got drivers that found none; {}check that the "
                      "GPU is there and may be opened (/dev/dri or nvidia-smi; a container must be "
                      "given it), install the driver that fits it ({}), {}",
                      overrides(), kDrivers, kWithout)};
}

Error only_bad_drivers(std::string_view bad) {
  return {ErrorCode::kNoDevice,
          fmt::format("Vulkan: expected a driver with a device, got only drivers that are left "
                      "alone: {}; update or remove them, install the one that fits your GPU ({}), "
                      "{}",
                      bad, kDrivers, kWithout)};
}

Error none_usable(std::string_view objections) {
  return {ErrorCode::kNoDevice,
          fmt::format("no usable Vulkan device: {}; update the driver of the one you want ({}), {}",
                      objections, kDrivers, kWithout)};
}

}  // namespace flowdlo::vulkan
