// Tuning: which gemm kernel a device gets, found out once and remembered.
#pragma once

#include <memory>

#include "vulkan/backend.hpp"
#include "vulkan/gemm_choice.hpp"

namespace flowdlo::vulkan {

/// What is known of this device, in this process or in options.pipeline_cache; otherwise the
/// candidates are tried. One that returns wrong numbers is passed over: that is the step down. A
/// GPU gets the fastest of those that fit into 100 ms. A CPU driver gets the fastest of its own
/// kernel's tiles that are begun within 2 s of the first, whose results have the same bits, and
/// without options.pipeline_cache the first. Fails with kNoDevice where none is right.
[[nodiscard]] Result<GemmChoice> choose_gemm(const std::shared_ptr<Device>& device,
                                             const ProgramOptions& options);

}  // namespace flowdlo::vulkan
