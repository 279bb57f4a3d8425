// ShaderCode: the SPIR-V of each shader, embedded at build time. A shader without its file does not
// link.
#pragma once

#include <cstdint>
#include <span>

namespace flowdlo::vulkan {

struct ShaderCode {
  const char* name = nullptr;
  std::span<const std::uint32_t> words;
  /// The same without subgroup shuffles, for devices that have none: what lanes hand to each other
  /// goes by shared memory, or all read it. Empty where `words` need none either.
  std::span<const std::uint32_t> plain{};
};

namespace shaders {

[[nodiscard]] ShaderCode add_upsampled();
[[nodiscard]] ShaderCode attention();
[[nodiscard]] ShaderCode convolution();
[[nodiscard]] ShaderCode farthest_points();
[[nodiscard]] ShaderCode farthest_setup();
[[nodiscard]] ShaderCode flow_step();
[[nodiscard]] ShaderCode frame_normalization();
[[nodiscard]] ShaderCode gemm();
[[nodiscard]] ShaderCode layer_norm();
[[nodiscard]] ShaderCode mask_features();
[[nodiscard]] ShaderCode matrix_gemm();  ///< no words where the GLSL compiler at hand was too old
[[nodiscard]] ShaderCode max_pool();
[[nodiscard]] ShaderCode narrow();
[[nodiscard]] ShaderCode normalize();
[[nodiscard]] ShaderCode tile_gemm();

/// Of the words of all of them.
[[nodiscard]] std::uint64_t hash();

}  // namespace shaders
}  // namespace flowdlo::vulkan
