#include "vulkan/shader_code.hpp"

namespace flowdlo::vulkan::shaders {

std::uint64_t hash() {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const ShaderCode& shader :
       {add_upsampled(), attention(), convolution(), farthest_points(), farthest_setup(),
        flow_step(), frame_normalization(), gemm(), layer_norm(), mask_features(), matrix_gemm(),
        max_pool(), narrow(), normalize(), tile_gemm()}) {
    for (const std::uint32_t word : shader.words) hash = (hash ^ word) * 1099511628211ULL;
    for (const std::uint32_t word : shader.plain) hash = (hash ^ word) * 1099511628211ULL;
    hash = (hash ^ (shader.words.size() + shader.plain.size())) * 1099511628211ULL;
  }
  return hash;
}

}  // namespace flowdlo::vulkan::shaders
