// StoredFile: what one device and driver are remembered by, in a folder, between processes.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "vulkan/device.hpp"

namespace flowdlo::vulkan {

/// Of the file that holds this, in whatever folder.
[[nodiscard]] std::string stored_name(const Device& device, std::string_view kind);

/// The content that was stored for this device under `kind` ("pipelines", "gemm"). Empty where
/// there is none, where the file is damaged, or where it was stored by another driver, driver
/// version, number of lanes, FlowDLO version or set of shaders.
[[nodiscard]] std::vector<char> read_stored(const Device& device,
                                            const std::filesystem::path& folder,
                                            std::string_view kind);

/// Stores the content, atomically. What cannot be written is not: the next process does without.
void write_stored(const Device& device, const std::filesystem::path& folder, std::string_view kind,
                  const std::vector<char>& content);

}  // namespace flowdlo::vulkan
