// Tuning: which gemm kernel a device gets, found out once and remembered.
#pragma once

#include <memory>

#include "vulkan/backend.hpp"
#include "vulkan/gemm_choice.hpp"

namespace flowdlo::vulkan {

/// What is known of this device, or stored in options.cache; otherwise the candidates are tried.
/// One that returns wrong numbers is passed over: that is the step down. A GPU gets the fastest of
/// those that fit into 100 ms, a CPU driver the first. Fails with kNoDevice where none is right.
[[nodiscard]] Result<GemmChoice> choose_gemm(const std::shared_ptr<Device>& device,
                                             const ProgramOptions& options);

}  // namespace flowdlo::vulkan
