// GemmTrial: dense layers with known answers on a device, timed. Drivers that return wrong numbers
// exist.
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "vulkan/device.hpp"
#include "vulkan/gemm_choice.hpp"

namespace flowdlo::vulkan {

/// Spoils results before they are looked at: how tests make a family fail.
using Disturb = std::function<void(const GemmChoice&, std::span<float>)>;

/// Milliseconds that a layer of each kind takes together, for four draws. Fails where they cannot
/// run, or where a sum differs from the one in double precision by more than f32 (kMatrix: f16)
/// explains.
[[nodiscard]] Result<double> try_gemm(const std::shared_ptr<Device>& device,
                                      const GemmChoice& choice, const Disturb& disturb);

}  // namespace flowdlo::vulkan
