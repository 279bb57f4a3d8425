// AbsentGpu: a Radeon that is not there, as Mesa's RADV knows it: a device that compiles and has no
// memory. Nothing may be allocated, mapped or submitted on it.
#pragma once

#include <memory>
#include <string>

#include "flowdlo/result.hpp"
#include "vulkan/device.hpp"

namespace flowdlo::gpu_compile {

/// Opens the family ("navi21") with pipelines that keep their statistics. `lanes`: of a subgroup,
/// where the family lets us choose; 0: as the engine chooses. Fails with kNoDevice where RADV is
/// not installed, or where it says nothing of its pipelines. RADV ends the process where it does
/// not know the family: whoever asks for many of them asks in a process each.
[[nodiscard]] Result<std::shared_ptr<vulkan::Device>> open_absent_gpu(const std::string& family,
                                                                      int lanes = 0);

/// The driver's library as dlopen() takes it; empty where RADV is not installed.
[[nodiscard]] std::string radv_library();

}  // namespace flowdlo::gpu_compile
