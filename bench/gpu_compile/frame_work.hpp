// FrameWork: the dispatches of a frame, recorded by the engine itself, none of which runs.
#pragma once

#include <memory>
#include <vector>

#include "vulkan/device.hpp"
#include "vulkan/plan.hpp"
#include "weights/field_weights.hpp"
#include "weights/weights.hpp"

namespace flowdlo::gpu_compile {

struct FrameWork {
  std::vector<vulkan::KernelSpec> kernels;
  std::vector<vulkan::Dispatch> dispatches;  ///< `kernel` is an index into `kernels`
};

/// The model's part of a 640 x 480 frame whose mask has 20,000 points.
[[nodiscard]] Result<FrameWork> model_work(const std::shared_ptr<vulkan::Device>& device,
                                           const vulkan::GemmChoice& gemm,
                                           const std::shared_ptr<const weights::Weights>& weights,
                                           int draws, int steps);

/// The strand field's, of 64 blocks: a rope across such a frame.
[[nodiscard]] Result<FrameWork> field_work(
    const std::shared_ptr<vulkan::Device>& device, const vulkan::GemmChoice& gemm,
    const std::shared_ptr<const weights::FieldWeights>& weights);

}  // namespace flowdlo::gpu_compile
