// CompiledKernel: what a driver's compiler says of one kernel
// (VK_KHR_pipeline_executable_properties).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vulkan/device.hpp"

namespace flowdlo::gpu_compile {

struct CompiledKernel {
  std::string name;  ///< as KernelSpec::name()
  int subgroup = 0;  ///< lanes, 32 or 64
  int vgprs = 0;     ///< registers of a lane
  int sgprs = 0;     ///< of a subgroup
  int spilled = 0;   ///< registers of both kinds that went to memory
  int scratch_bytes = 0;
  int lds_bytes = 0;  ///< shared memory of a workgroup
  int code_bytes = 0;
  /// A SIMD holds so many at once. RADV counts a subgroup of 64 lanes twice where a SIMD has 32 of
  /// them (RDNA).
  int waves = 0;
  /// Cycles that the compiler expects one subgroup alone to take, and cycles of a SIMD for each 64
  /// invocations when there are plenty; each loop counted 8 times, a loop within it 32 times.
  double latency = 0;
  double cycles_of_64 = 0;
  /// Instructions outside loops, in loops, in loops within loops, ...
  std::vector<double> instructions_by_depth;
};

/// The compiled kernel's figures. Fails with kInternal where the driver does not give one of them.
[[nodiscard]] Result<CompiledKernel> figures_of(const vulkan::Device& device,
                                                const vulkan::KernelSpec& spec,
                                                const vulkan::Kernel& kernel);

/// Of a listing as RADV prints it: "BB3:" at the head of each block, an instruction a line.
[[nodiscard]] std::vector<double> instructions_by_depth(std::string_view assembly);

}  // namespace flowdlo::gpu_compile
