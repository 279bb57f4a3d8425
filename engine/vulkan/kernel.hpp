// Kernel: a compute pipeline with its layouts, made from a shader and its specialisation constants.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "flowdlo/result.hpp"
#include "vulkan/binding.hpp"
#include "vulkan/owned.hpp"
#include "vulkan/shader_code.hpp"

namespace flowdlo::vulkan {

class Device;

/// What makes one kernel differ from another. Constant i has constant_id i; constant 0 is the
/// workgroup's size, a multiple of the lanes where the kernel uses subgroups.
struct KernelSpec {
  ShaderCode shader;
  std::vector<std::uint32_t> constants;
  std::vector<BindingKind> bindings;
  std::uint32_t push_bytes = 0;
  bool uses_subgroups = true;

  /// Shader and constants, "gemm 8 256 16 8 2 0 1": unique among kernels.
  [[nodiscard]] std::string name() const;
};

class Kernel {
 public:
  [[nodiscard]] static Result<Kernel> create(const Device& device, const KernelSpec& spec);

  [[nodiscard]] VkPipeline pipeline() const { return pipeline_.get(); }
  [[nodiscard]] VkPipelineLayout layout() const { return layout_.get(); }
  [[nodiscard]] VkDescriptorSetLayout set_layout() const { return set_layout_.get(); }

 private:
  Kernel() = default;

  Owned<VkDescriptorSetLayout> set_layout_;
  Owned<VkPipelineLayout> layout_;
  Owned<VkPipeline> pipeline_;
};

}  // namespace flowdlo::vulkan
