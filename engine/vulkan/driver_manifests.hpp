// DriverManifests: the JSON files by which the Vulkan loader finds its drivers, found as it does.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace flowdlo::vulkan {

/// A variable of the environment by its name; null where it is not set.
using Variable = std::function<const char*(const char*)>;

/// Where the loader looks on Linux, in its order: VK_DRIVER_FILES or VK_ICD_FILENAMES alone where
/// one is set, otherwise VK_ADD_DRIVER_FILES and then vulkan/icd.d below XDG's folders and /etc.
/// Each file once, absolute; those of a folder by name, where the loader takes them as they come.
[[nodiscard]] std::vector<std::filesystem::path> driver_manifests(const Variable& variable);

/// The driver that a manifest names, as dlopen() wants it: a path, or a name that the dynamic
/// linker looks for. Empty where the manifest says nothing, or cannot be read.
[[nodiscard]] std::string driver_library(const std::filesystem::path& manifest);

}  // namespace flowdlo::vulkan
