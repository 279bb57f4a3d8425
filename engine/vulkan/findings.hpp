// Findings: what was measured of a device, kept within this process and in a folder between them.
// Whoever would measure it again is told the same: noise must not change a device's bits from one
// estimator to the next.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace flowdlo::vulkan {

class Device;

/// What is known of this device under `kind`, at most 16 characters; empty where nothing is.
/// `folder` empty: nothing is kept between processes.
[[nodiscard]] std::vector<char> known(const Device& device, const std::filesystem::path& folder,
                                      std::string_view kind);

/// Keeps `found`, unless another estimator was first: then what that one found. What is kept.
[[nodiscard]] std::vector<char> settle(const Device& device, const std::filesystem::path& folder,
                                       std::string_view kind, const std::vector<char>& found);

/// Tests' way to be a new process: this process's own memory is emptied.
void forget_findings();

}  // namespace flowdlo::vulkan
