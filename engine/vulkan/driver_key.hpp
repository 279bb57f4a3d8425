// DriverKey: what a verdict about a driver was found for; where any of it changes, it is asked
// anew.
#pragma once

#include <filesystem>
#include <string>

namespace flowdlo::vulkan {

struct DriverKey {
  /// The manifest and the library with their sizes and times, the loader, the kernel's release,
  /// the GPUs' device nodes and who may open them, and the variables that drivers read.
  std::string text;
  bool names_library = false;  ///< false: the library was not found, and may change unseen
};

/// `loader`: its version.
[[nodiscard]] DriverKey driver_key(const std::filesystem::path& manifest,
                                   const std::string& loader);

}  // namespace flowdlo::vulkan
