// Candidates: every way in which a device could run the dense layers.
#pragma once

#include <vector>

#include "vulkan/gemm_choice.hpp"
#include "vulkan/physical_device.hpp"

namespace flowdlo::vulkan {

/// What a device may run, likely best first. CPU drivers: shuffles, then tiles. GPUs: cooperative
/// matrices where there are any, tiles, shuffles. Tiles need nothing special and are always there.
[[nodiscard]] std::vector<GemmChoice> gemm_candidates(const PhysicalDevice& device);

/// Threads of a workgroup in kTile or kMatrix.
[[nodiscard]] int threads_of(const GemmChoice& choice, const PhysicalDevice& device);

}  // namespace flowdlo::vulkan
