// Pipeline cache: compiled kernels kept in a folder between processes.
#pragma once

#include <filesystem>

#include "vulkan/device.hpp"

namespace flowdlo::vulkan {

/// Adds what the folder holds for this device and driver. A file that is missing, damaged, or of
/// another device or driver is ignored: the kernels are then compiled.
void load_pipelines(const Device& device, const std::filesystem::path& folder);

/// Writes the device's compiled kernels, atomically. What cannot be written is not: the next
/// process compiles again.
void store_pipelines(const Device& device, const std::filesystem::path& folder);

}  // namespace flowdlo::vulkan
