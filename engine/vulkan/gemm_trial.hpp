// GemmTrial: dense layers with known answers on a device, timed. Drivers that return wrong numbers
// exist.
#pragma once

#include <memory>

#include "vulkan/backend.hpp"
#include "vulkan/gemm_choice.hpp"

namespace flowdlo::vulkan {

/// Milliseconds that a layer of each kind takes together, for four draws (CPU drivers, which nobody
/// compares: one). Fails where they cannot run within options.timeout_ms, or where a sum differs
/// from the one in double precision by more than f32 (kMatrix: f16) explains.
[[nodiscard]] Result<double> try_gemm(const std::shared_ptr<Device>& device,
                                      const GemmChoice& choice, const ProgramOptions& options);

}  // namespace flowdlo::vulkan
