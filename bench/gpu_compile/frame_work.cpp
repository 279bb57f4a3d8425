#include "gpu_compile/frame_work.hpp"

#include "field/network.hpp"
#include "flow/sampler.hpp"
#include "vulkan/program.hpp"

namespace flowdlo::gpu_compile {
namespace {

/// Programs that are looked at in place of being built.
std::function<std::unique_ptr<ops::Program>()> looked_at(
    const std::shared_ptr<vulkan::Device>& device, const vulkan::GemmChoice& gemm,
    FrameWork& work) {
  return [device, gemm, &work] {
    vulkan::ProgramOptions options;
    options.gemm = gemm;
    options.inspect = [&work](const vulkan::Plan& plan) {
      work.kernels = plan.kernels();
      for (const vulkan::Step& step : plan.steps()) {
        if (const auto* dispatch = std::get_if<vulkan::Dispatch>(&step)) {
          work.dispatches.push_back(*dispatch);
        }
      }
    };
    return std::make_unique<vulkan::Program>(device, options);
  };
}

}  // namespace

Result<FrameWork> model_work(const std::shared_ptr<vulkan::Device>& device,
                             const vulkan::GemmChoice& gemm,
                             const std::shared_ptr<const weights::Weights>& weights, int draws,
                             int steps) {
  FrameWork work;
  const flow::SamplerConfig config{
      .draws = draws,
      .steps = steps,
      .seed = 0,
      .capacity = {.cloud_points = 20000, .field_texels = 320 * 240, .image_pixels = 640 * 480}};
  const auto recorded = flow::Sampler::create(weights, looked_at(device, gemm, work), config);
  if (!recorded) return recorded.error();
  return work;
}

Result<FrameWork> field_work(const std::shared_ptr<vulkan::Device>& device,
                             const vulkan::GemmChoice& gemm,
                             const std::shared_ptr<const weights::FieldWeights>& weights) {
  FrameWork work;
  const auto recorded = field::Network::create(weights, looked_at(device, gemm, work));
  if (!recorded) return recorded.error();
  return work;
}

}  // namespace flowdlo::gpu_compile
