// VK_KHR_cooperative_matrix as its specification has it, for Vulkan headers older than it.
#pragma once

#include <array>
#include <cstdint>

#include "vulkan/vulkan_api.hpp"

namespace flowdlo::vulkan {

inline constexpr const char* kCooperativeMatrixExtension = "VK_KHR_cooperative_matrix";
inline constexpr std::uint32_t kCooperativeMatrixVersion = VK_MAKE_API_VERSION(0, 1, 3, 255);
inline constexpr auto kCooperativeMatrixFeaturesType = static_cast<VkStructureType>(1000506000);
inline constexpr auto kCooperativeMatrixPropertiesType = static_cast<VkStructureType>(1000506001);

struct CooperativeMatrixFeatures {
  VkStructureType sType = kCooperativeMatrixFeaturesType;
  void* pNext = nullptr;
  VkBool32 cooperativeMatrix = VK_FALSE;
  VkBool32 cooperativeMatrixRobustBufferAccess = VK_FALSE;
};

/// What matrix_gemm needs: cooperative matrices, f16 arithmetic, and Vulkan's memory model.
inline constexpr std::array kMatrixExtensions{kCooperativeMatrixExtension,
                                              VK_KHR_SHADER_FLOAT16_INT8_EXTENSION_NAME,
                                              VK_KHR_VULKAN_MEMORY_MODEL_EXTENSION_NAME};

/// Those features, as a chain to ask with or to enable.
struct MatrixFeatures {
  CooperativeMatrixFeatures matrix{};
  VkPhysicalDeviceShaderFloat16Int8Features arithmetic{};
  VkPhysicalDeviceVulkanMemoryModelFeatures memory{};

  [[nodiscard]] void* chain(void* next = nullptr) {
    memory.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_MEMORY_MODEL_FEATURES;
    memory.pNext = next;
    arithmetic.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_FLOAT16_INT8_FEATURES;
    arithmetic.pNext = &memory;
    matrix.pNext = &arithmetic;
    return &matrix;
  }
  [[nodiscard]] bool complete() const {
    return matrix.cooperativeMatrix == VK_TRUE && arithmetic.shaderFloat16 == VK_TRUE &&
           memory.vulkanMemoryModel == VK_TRUE;
  }
};

enum class MatrixComponent : std::int32_t { kFloat16 = 0, kFloat32 = 1 };
enum class MatrixScope : std::int32_t { kSubgroup = 3 };

struct CooperativeMatrixProperties {
  VkStructureType sType = kCooperativeMatrixPropertiesType;
  void* pNext = nullptr;
  std::uint32_t MSize = 0;
  std::uint32_t NSize = 0;
  std::uint32_t KSize = 0;
  MatrixComponent AType{};
  MatrixComponent BType{};
  MatrixComponent CType{};
  MatrixComponent ResultType{};
  VkBool32 saturatingAccumulation = VK_FALSE;
  MatrixScope scope{};
};

using GetCooperativeMatrixProperties = VkResult(VKAPI_PTR*)(VkPhysicalDevice, std::uint32_t*,
                                                            CooperativeMatrixProperties*);

}  // namespace flowdlo::vulkan
